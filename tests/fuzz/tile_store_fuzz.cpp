// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): tile_store_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. `--seeds` writes what to begin from and ends.

#include "fuzz/tile_store_fuzz.h"

#include "fuzz/seeds.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    lodbench::test::write_seeds_if_asked(*argc, *argv, [] {
        std::vector<std::string> seeds;
        for (const std::string& store : lodbench::test::seed_stores()) {
            for (const char mode : {'\0', '\1', '\3'}) seeds.push_back(mode + store);
        }
        return seeds;
    });
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)lodbench::test::use_as_store({data, size});
    return 0;
}
