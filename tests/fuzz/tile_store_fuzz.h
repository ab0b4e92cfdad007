#pragma once
// Any bytes as a tiled store: whatever they are, they are refused or read, and nothing else
// happens.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/error.h"
#include "support/tile_store_files.h"
#include "terrain/open_terrain.h"
#include "terrain/tile_store_check.h"

namespace lodbench::test {

/// A file in memory that has a path for as long as the object lives.
class MemoryFile {
public:
    explicit MemoryFile(const std::string& bytes) : descriptor_(memfd_create("store", 0)) {
        if (write(descriptor_, bytes.data(), bytes.size()) != ssize_t(bytes.size())) std::abort();
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] std::string path() const {
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

private:
    int descriptor_;
};

/// The first byte says what is made to hold before: 1 the checksum of header and index, 2 those of
/// the tiles, so that what lies behind these checks is reached too. Returns whether the rest could
/// be opened.
inline bool use_as_store(std::span<const std::uint8_t> input) {
    if (input.empty()) return false;
    std::string bytes(input.begin() + 1, input.end());
    if (bytes.size() >= 1024 && (input[0] & 2U) != 0) {
        const auto tiles = field_at<std::uint64_t>(bytes, 120);
        const auto record = field_at<std::uint64_t>(bytes, 136);
        for (std::uint64_t i = 0; i < tiles && 1024 + (i + 1) * 32 <= bytes.size(); ++i) {
            const auto offset = field_at<std::uint64_t>(bytes, 1024 + i * 32);
            if (record <= bytes.size() && offset <= bytes.size() - record) sign_tile(bytes, i);
        }
    }
    if (bytes.size() >= 1024 && (input[0] & 1U) != 0) sign(bytes);
    const MemoryFile file(bytes);
    try {
        const terrain::StoredTerrain store(file.path());
        try {
            std::vector<float> all(std::size_t(store.info().rows) *
                                   std::size_t(store.info().columns));
            store.read({0, 0, store.info().rows, store.info().columns}, all);
        } catch (const TerrainError&) {
        }
        (void)terrain::check_tiles(store);
        try {
            (void)terrain::whole_field(store);
        } catch (const TerrainError&) {
        }
        return true;
    } catch (const InputError&) {
        return false;
    } catch (const EnvironmentError&) {
        return false;
    }
}

/// Small stores of both kinds, to begin from.
inline std::vector<std::string> seed_stores() {
    const TemporaryFolder folder;
    std::vector<std::string> stores;
    for (const auto& [rows, columns] : {std::pair{2, 2}, {66, 3}, {70, 130}}) {
        for (const bool steps : {false, true}) {
            terrain::write_store(rough_field(rows, columns, 1),
                                 steps ? std::optional(0.5) : std::nullopt,
                                 folder.path() / "s.tiles");
            stores.push_back(bytes_of(folder.path() / "s.tiles"));
        }
    }
    return stores;
}

}  // namespace lodbench::test
