#pragma once
// Two results folders held against each other by compare_truth.py.

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/run_lodbench.h"

namespace lodbench::test {

/// The same measured figures, and some.
inline void expect_equal_truth(const fs::path& before, const fs::path& after) {
    const fs::path found = after / "compared.txt";
    const std::string command = "/usr/bin/python3 " LODBENCH_SOURCE_DIR
                                "/tests/support/compare_truth.py " +
                                before.string() + " " + after.string() + " > " + found.string();
    EXPECT_EQ(std::system(command.c_str()), 0) << text_of(found);
    EXPECT_NE(text_of(found).find(" 0 not"), std::string::npos) << text_of(found);
}

}  // namespace lodbench::test
