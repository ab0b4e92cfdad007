#pragma once
// Papers of a few lines, written to a folder of the test's own.

#include <filesystem>
#include <fstream>
#include <string>

#include "support/run_lodbench.h"

namespace lodbench::test {

/// What every paper has; more may follow.
inline const std::string kPaperHead = R"(title = "A paper"
citation = "Somebody: A paper. 2000"
hardware = "a machine"
[terrain]
name = "a ramp"
[[experiment]]
id = "flight"
did = "flew"
scenarios = ["tiny.toml"]
)";

/// A paper whose scenario is `tiny_scenario`, and what follows its experiment.
inline fs::path paper_file(const fs::path& folder, const std::string& rest,
                           const std::string& name = "paper") {
    if (!fs::exists(folder / "tiny.toml")) tiny_scenario(folder, "repetitions = 2\n");
    const fs::path file = folder / (name + ".toml");
    std::ofstream(file) << kPaperHead << rest;
    return file;
}

}  // namespace lodbench::test
