# Shared by the scripts beside it: sourced, never run.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

say() { printf '== %s\n' "$*"; }
fail() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# The names in scripts/packages, one a line.
wanted_packages() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' -e 's/[[:space:]]*$//' "$root/scripts/packages"; }

missing_packages() {
    {
        dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p'
        echo --
        wanted_packages
    } | awk '$0 == "--" { wanted = 1; next } !wanted { installed[$0]; next } !($0 in installed)'
}

# Installs what scripts/packages names and the system lacks, and nothing else.
install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say "not a Debian system: the equivalents of scripts/packages must be installed already"
        return
    fi
    local names missing become=()
    names=$(missing_packages)
    [[ $names ]] || return 0
    mapfile -t missing <<<"$names"
    if ((EUID != 0)); then
        command -v sudo >/dev/null ||
            fail "${#missing[@]} packages are missing and there is no sudo; as root, run: apt-get install ${missing[*]}"
        become=(sudo)
        [[ -t 0 ]] || become+=(--non-interactive)
        "${become[@]}" true ||
            fail "${#missing[@]} packages are missing and sudo refused; as root, run: apt-get install ${missing[*]}"
    fi
    local apt=("${become[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet)
    local install=("${apt[@]}" install --yes --no-install-recommends "${missing[@]}")
    say "installing ${#missing[@]} packages: ${missing[*]}"
    # The package index is fetched only where it does not know the packages, or knows files that are gone.
    if "${install[@]}" --simulate >/dev/null 2>&1 && "${install[@]}"; then return; fi
    "${apt[@]}" update && "${install[@]}" || fail "apt-get could not install: ${missing[*]}"
}

# One job for each processor that this process may use.
job_count() { nproc; }

# configure PRESET [OPTION]...: scripts/demo and scripts/test share a folder and its flags, so that neither builds again
# what the other has built. Warnings are errors with the compiler that they are known of, Debian 12's.
configure() {
    local preset=$1 flags=()
    shift
    [[ $("${CXX:-c++}" -dumpversion 2>/dev/null) != 12 ]] || flags=(-DLODBENCH_WERROR=ON)
    (cd "$root" && cmake --preset "$preset" --log-level=WARNING "${flags[@]}" "$@")
}

# fly_baseline OUT: the flight of results/baseline, by software whatever GPU there is. Two methods fly finer than by
# default: of blocks as large as the terrain, 32 triangles would guard nothing.
fly_baseline() {
    "$root/build/release/bin/lodbench" run "$root/scenarios/baseline.toml" --device software --out "$1" \
        --set dss.tau=0.1 --set tess-pow2.tau=0.1
}

# A new folder for a flight that scripts keep, and say where it is.
new_results_folder() {
    mkdir -p "$root/lodbench-results"
    mktemp --directory "$root/lodbench-results/$1-$(date --utc +%Y-%m-%dT%H-%M-%SZ)-XXXX"
}
