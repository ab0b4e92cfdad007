#pragma once
// What every libFuzzer target of this folder has in common: NAME [--seeds FOLDER | libFuzzer's own
// arguments].

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace lodbench::test {

/// Where the command line is `--seeds FOLDER`: writes each of `make_seeds()` into a file of that
/// folder and ends the process. Returns otherwise.
template <typename MakeSeeds>
void write_seeds_if_asked(int argc, char** argv, const MakeSeeds& make_seeds) {
    if (argc != 3 || std::strcmp(argv[1], "--seeds") != 0) return;
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const std::string& seed : std::vector<std::string>(make_seeds())) {
        std::ofstream file(folder / ("seed" + std::to_string(number++)), std::ios::binary);
        if (!(file << seed).flush()) std::exit(1);
    }
    std::exit(0);
}

}  // namespace lodbench::test

/// What libFuzzer calls: `use_` takes the bytes as text, `seeds_` gives what to begin from.
#define LODBENCH_FUZZ_TARGET(use_, seeds_)                                              \
    extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {                      \
        lodbench::test::write_seeds_if_asked(*argc, *argv, seeds_);                     \
        return 0;                                                                       \
    }                                                                                   \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
        use_({reinterpret_cast<const char*>(data), size});                              \
        return 0;                                                                       \
    }
