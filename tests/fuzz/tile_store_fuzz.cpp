// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): tile_store_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. `--seeds` writes what to begin from and ends.

#include <cstring>
#include <filesystem>
#include <fstream>

#include "fuzz/tile_store_fuzz.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    if (*argc == 3 && std::strcmp((*argv)[1], "--seeds") == 0) {
        const std::filesystem::path folder = (*argv)[2];
        std::filesystem::create_directories(folder);
        int number = 0;
        for (const std::string& store : lodbench::test::seed_stores()) {
            for (const char mode : {'\0', '\1', '\3'}) {
                std::ofstream(folder / ("seed" + std::to_string(number++)), std::ios::binary)
                    << mode << store;
            }
        }
        std::exit(0);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)lodbench::test::use_as_store({data, size});
    return 0;
}
