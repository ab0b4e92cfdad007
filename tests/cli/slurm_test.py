"""A campaign by scripts/slurm on a Slurm of its own: a killed task, a drained and a failed node, and at the end every
cell once, as an unsharded run has it.

usage: slurm_test.py SOURCE_DIR LODBENCH_BINARY

Starts munged, slurmctld and slurmd with files, ports and a socket of their own, as whoever runs it. Exit status 77
where Slurm (Debian: slurm-wlm, munge) is not installed or does not start here.
"""

import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
BINARY = pathlib.Path(sys.argv.pop(1)).resolve()
SLURM = SOURCE / "scripts" / "slurm"
SHARDS = 8
COMMAND = ["run", "--method", "template", "--method", "lindstrom", "--method", "full-grid", "--repeat", "4",
           "--frames", "3", "--size", "160x120"]  # of the demo
SKIPPED = 77


def skip(reason):
    print("skipped:", reason)
    sys.exit(SKIPPED)


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class PrivateSlurm:
    """One node; what it starts, it ends."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        self.node = socket.gethostname().split(".")[0]
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        controller, worker = free_ports(2)
        for part in ["state", "spool"]:
            (folder / part).mkdir()
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        (folder / "slurm.conf").write_text(f"""
ClusterName=private
SlurmctldHost={self.node}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={worker}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=0
KillWait=5
GresTypes=gpu
NodeName={self.node} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 Gres=gpu:2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        # Devices that every machine has, to be counted and bound, and not drawn on.
        (folder / "gres.conf").write_text("".join(f"NodeName={self.node} Name=gpu File=/dev/{file}\n"
                                                  for file in ["null", "zero"]))
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"),
                                PATH=os.environ["PATH"] + ":/usr/sbin")

    def start(self):
        """"" or why it does not run."""
        for name, options in {
            "munged": ["--foreground", "--force", f"--socket={self.folder}/munge.socket",
                       f"--key-file={self.folder}/munge.key", f"--pid-file={self.folder}/munged.pid",
                       f"--log-file={self.folder}/munged.log", f"--seed-file={self.folder}/seed"],
            "slurmctld": ["-D"],
            "slurmd": ["-D"],
        }.items():
            log = open(self.folder / f"{name}.out", "w")
            self.daemons.append(subprocess.Popen([name, *options], env=self.environment, stdout=log, stderr=log,
                                                 start_new_session=True))
            time.sleep(1)
        for _ in range(60):
            state = self.call("sinfo", "--noheader", "--format=%T", check=False).stdout.strip()
            if state == "idle":
                return ""
            time.sleep(0.5)
        logs = "".join(f"{name}: {(self.folder / f'{name}.out').read_text()[-300:]}\n"
                       for name in ["munged", "slurmctld", "slurmd"])
        return f"the node is '{state}'\n{logs}"

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def call(self, *command, check=True):
        done = subprocess.run([str(word) for word in command], env=self.environment, capture_output=True, text=True,
                              timeout=120, cwd=self.folder)
        if check and done.returncode != 0:
            raise AssertionError(f"{command} ended with {done.returncode}: {done.stdout}{done.stderr}")
        return done

    def set_node(self, state):
        self.call("scontrol", "update", f"nodename={self.node}", f"state={state}", "reason=test")

    def jobs(self, states):
        lines = self.call("squeue", "--noheader", "--array", "--format=%i", f"--states={states}").stdout.split()
        return lines


def wait_for(condition, what, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.2)
    raise AssertionError(f"waited {seconds} s for {what}")


def flying(out):
    """The lodbench of each shard that flies now, by its number."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if len(words) > 2 and words[0] == str(BINARY).encode() and words[1] == b"run":
            place = [word for word in words if word.startswith(str(out / "shards").encode() + b"/")]
            if place:
                found[int(place[0].rsplit(b"/", 1)[1])] = int(entry.name)
    return found


def cells_of(folder):
    cells = [json.loads(line) for line in (folder / "cells.jsonl").read_text().splitlines()]
    by_name = {cell["cell"]: cell for cell in cells}
    assert len(by_name) == len(cells), "a cell is there twice"
    return by_name


class Campaign(unittest.TestCase):
    def test_array_of_8_shards_survives_a_kill_a_drain_and_a_failed_node(self):
        out = folder / "campaign"
        slurm.call(SLURM / "submit", "--shards", SHARDS, "--out", out, "--lodbench", BINARY, "--", *COMMAND)

        # One task is killed: it is requeued by itself and goes on.
        killed, process = wait_for(lambda: next(iter(flying(out).items()), None), "a task that flies", 120)
        wait_for(lambda: (out / "shards" / str(killed) / "run.json").exists(), "its folder", 120)
        os.kill(process, signal.SIGKILL)
        log = out / "logs" / f"{killed}.log"
        wait_for(lambda: "was ended from outside (137)" in log.read_text(), "its end", 60)
        self.assertFalse((out / "status" / str(killed)).exists(), "a kill is not the exit status of a shard")

        # The node is drained: nothing new begins, what runs ends; then it fails under the next tasks.
        slurm.set_node("drain")
        wait_for(lambda: not slurm.jobs("running,completing"), "the drained node to be empty", 600)
        self.assertTrue(slurm.jobs("pending"))
        self.assertFalse(flying(out))
        slurm.set_node("resume")
        wait_for(lambda: flying(out), "tasks on the resumed node", 120)
        slurm.set_node("down")
        wait_for(lambda: not flying(out), "the failed node's tasks to end", 120)
        slurm.set_node("resume")

        wait_for(lambda: not slurm.jobs("all") or not slurm.jobs("pending,running,completing"), "all jobs", 1200)
        for _ in range(3):
            left = slurm.call(SLURM / "unfinished", out).stdout.split()
            if not left:
                break
            slurm.call(SLURM / "submit", "--again", "--out", out, "--lodbench", BINARY)
            wait_for(lambda: not slurm.jobs("pending,running,completing"), f"shards {left}", 1200)
        logs = "".join(file.read_text() for file in sorted((out / "logs").iterdir()))
        self.assertEqual([(out / "status" / str(n)).read_text() for n in range(1, SHARDS + 1)], ["0\n"] * SHARDS, logs)
        self.assertEqual((out / "status" / "merge").read_text(), "0\n", logs)
        self.assertIn("start 2", log.read_text(), "the killed task was requeued")
        self.assertTrue((out / "merged" / "report.html").exists())

        whole = folder / "whole"
        subprocess.run([BINARY, *COMMAND, "--out", whole], check=True, capture_output=True, timeout=1800)
        expected, merged = cells_of(whole), cells_of(out / "merged")
        self.assertEqual(len(expected), 12)
        self.assertEqual(sorted(merged), sorted(expected))
        fields = re.findall(r'DeterministicField\{"(\w+)"', (SOURCE / "harness/results/deterministic.cpp").read_text())
        self.assertGreater(len(fields), 20)
        for name, cell in expected.items():
            for field in fields:
                self.assertEqual(merged[name][field], cell[field], f"{field} of {name}")

    def test_task_that_is_told_to_end_keeps_its_cells_and_goes_on_when_submitted_again(self):
        out = folder / "told"
        slurm.call(SLURM / "submit", "--shards", 1, "--out", out, "--lodbench", BINARY, "--", *COMMAND)
        cells = out / "shards" / "1" / "cells.jsonl"
        wait_for(lambda: cells.exists() and flying(out), "the first cell", 120)
        array = slurm.call("squeue", "--noheader", "--name=lodbench", "--format=%A", "--states=running").stdout.split()[0]
        slurm.call("scancel", "--batch", "--signal=TERM", array)  # as before the limit of time
        wait_for(lambda: not slurm.jobs("pending,running,completing"), "the merge of what there is", 300)
        self.assertIn("ended from outside", (out / "logs" / "1.log").read_text())
        self.assertFalse((out / "status" / "1").exists())
        self.assertEqual((out / "status" / "merge").read_text(), "3\n", "cells are missing")
        kept = cells.read_text()
        self.assertLess(len(cells_of(out / "merged")), 12)

        slurm.call(SLURM / "submit", "--again", "--out", out, "--lodbench", BINARY)
        wait_for(lambda: not slurm.jobs("pending,running,completing"), "the rest", 600)
        self.assertEqual((out / "status" / "1").read_text(), "0\n")
        self.assertEqual((out / "status" / "merge").read_text(), "0\n")
        self.assertTrue(cells.read_text().startswith(kept), "what was flown is not flown again")
        self.assertEqual(len(cells_of(out / "merged")), 12)
        self.assertEqual(slurm.call(SLURM / "unfinished", out).stdout, "")

    def seen_by_tasks(self, name, *options):
        """Submits two tasks of a program that notes its GPUs and when it ran: [(GPUs, begin, end)]."""
        program = folder / "notes"
        program.write_text("""#!/usr/bin/env bash
[[ $1 == run ]] || exit 0
for ((i = 1; i < $#; ++i)); do [[ ${!i} != --out ]] || { next=$((i + 1)); out=${!next}; }; done
begin=$(date +%s.%N); sleep 4
echo "${CUDA_VISIBLE_DEVICES-none} $begin $(date +%s.%N)" >"$out.seen"
""")
        program.chmod(0o755)
        out = folder / name
        slurm.call(SLURM / "submit", "--shards", "2", "--out", out, "--lodbench", program, *options, "--", "run")
        wait_for(lambda: not slurm.jobs("pending,running,completing"), "both tasks", 120)
        lines = [(out / "shards" / f"{n}.seen").read_text().split() for n in [1, 2]]
        return [(gpus, float(begin), float(end)) for gpus, begin, end in lines]

    def test_gpu_binds_each_task_to_one_of_its_own(self):
        (first, begin, end), (second, later_begin, later_end) = self.seen_by_tasks("gpu", "--gpu")
        self.assertEqual({first, second}, {"0", "1"})
        self.assertLess(max(begin, later_begin), min(end, later_end), "they ran side by side")
        (first, *_), (second, *_) = self.seen_by_tasks("without")
        self.assertEqual((first, second), ("none", "none"))

    def test_exclusive_gives_each_task_the_node_alone(self):
        (_, begin, end), (_, later_begin, later_end) = sorted(self.seen_by_tasks("alone", "--exclusive"),
                                                              key=lambda task: task[1])
        self.assertLess(end, later_begin, "one after the other, though the node has two cores")
        self.assertLess(later_begin, later_end)

    def test_what_cannot_be_submitted_is_refused(self):
        for words, remedy in [
            (["--shards", "3"], "--out DIR is missing"),
            (["--shards", "0", "--out", folder / "none", "--", "run"], "expected a number from 1"),
            (["--shards", "2", "--out", folder / "none", "--", "match"], "expected '-- run ...'"),
            (["--shards", "2", "--out", folder / "none", "--", "run", "--resume"], "leave it out"),
            (["--shards", "100000", "--out", folder / "none", "--", "run"], "takes arrays of up to 1000 tasks"),
            (["--again", "--out", folder / "none"], "nothing was submitted into it"),
        ]:
            done = slurm.call(SLURM / "submit", *words, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(remedy, done.stderr)
            self.assertFalse((folder / "none").exists())


if __name__ == "__main__":
    for program in ["munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "sinfo"]:
        if shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin") is None:
            skip(f"{program} is not installed (Debian: slurm-wlm, munge)")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="lodbench-slurm-"))
    folder.chmod(0o755)  # munged refuses a folder that others may write to
    slurm = PrivateSlurm(folder)
    try:
        reason = slurm.start()
        if reason:
            skip(f"Slurm does not start here: {reason}")
        result = unittest.main(exit=False).result
    finally:
        slurm.stop()
        if os.environ.get("LODBENCH_KEEP_SLURM") is None:
            shutil.rmtree(folder, ignore_errors=True)
    sys.exit(0 if result.wasSuccessful() else 1)
