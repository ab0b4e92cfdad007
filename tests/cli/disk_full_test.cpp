// A disk that takes no more: a limit on the size of files stands in for it, since it needs no
// privilege.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

TEST(DiskFull, ends_with_a_clear_error_and_keeps_finished_cells) {
    const ScratchFolder folder;
    const fs::path out = folder.path() / "out";
    const std::string scenario = tiny_scenario(folder.path(), "repetitions = 12\n").string();
    // Room for the files of a cell and some lines of cells.jsonl, but not for twelve.
    const auto limit = [] {
        const rlimit bytes{16 << 10, 16 << 10};
        setrlimit(RLIMIT_FSIZE, &bytes);
        signal(SIGXFSZ, SIG_IGN);
    };
    const Finished finished =
        run_lodbench({"run", scenario, "--out", out.string(), "--method", "template", "--no-truth"},
                     folder.path(), limit);
    EXPECT_EQ(finished.status, 3) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("cannot append to " + (out / "cells.jsonl").string() +
                                           ": File too large; make room there"));
    EXPECT_FALSE(fs::exists(out / "views")) << "the room is the results'";
    const std::size_t kept = cells_of(out).size();
    EXPECT_GT(kept, 0U);
    EXPECT_LT(kept, 12U);
    EXPECT_EQ(run_lodbench({"run", "--resume", "--out", out.string()}, folder.path()).status, 0);
    EXPECT_EQ(cells_of(out).size(), 12U);
}

TEST(DiskFull, a_folder_that_cannot_be_made_measures_nothing) {
    const ScratchFolder folder;
    std::ofstream(folder.path() / "file") << "in the way";
    const Finished finished =
        run_lodbench({"run", tiny_scenario(folder.path(), "repetitions = 1\n").string(), "--out",
                      (folder.path() / "file" / "out").string(), "--method", "template"},
                     folder.path());
    EXPECT_EQ(finished.status, 4) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("cannot make the folder"));
}

}  // namespace
}  // namespace lodbench::test
