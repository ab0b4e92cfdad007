#pragma once
// Whether every tile of a store is what it should be.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "terrain/tile_store.h"

namespace lodbench::terrain {

struct StoreReport {
    std::uint64_t tiles = 0;          ///< read
    std::uint64_t bytes = 0;          ///< of these tiles
    std::uint64_t fault_count = 0;    ///< tiles with a fault, and one where the grid has another
    std::vector<std::string> faults;  ///< the first of them: "tile (...): what is wrong"
};

/// Reads every tile once and compares: its bytes with the index's checksum; its borders with those
/// of its neighbours, and what lies beyond the grid with the grid's edge (level 0); its heights
/// with what the finer levels make of them (other levels); its summary with what its samples and
/// the finer levels make of it; and all heights with the grid's checksum. What follows from a fault
/// elsewhere is no fault. Memory as for building a store. `most` faults are put in words.
[[nodiscard]] StoreReport check_tiles(const StoredTerrain& store, std::size_t most = 20);

}  // namespace lodbench::terrain
