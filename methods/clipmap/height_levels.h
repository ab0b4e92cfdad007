#pragma once
// Heights of all levels, as far as they are in memory: coarse levels wholly, of fine ones the tiles
// that were used last, which threads read.

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "api/terrain.h"
#include "clipmap/tent_terrain.h"
#include "common/tile_loader.h"
#include "common/tile_pool.h"
#include "common/toroidal_window.h"

namespace lodbench::clipmap {

struct HeightLevelsOptions {
    int levels = 1;        ///< >= 1; more than the terrain's pyramid has are made from its coarsest
    bool filtered = true;  ///< how those are made
    /// A level of at most so many samples an edge (and of 65) is held wholly.
    int resident_samples = 65;
    int window_samples = 15;  ///< of the windows that are filled from here
    int loader_threads = 2;   ///< >= 1
};

/// Samples beyond a level's grid have the height of the nearest one that is there.
class HeightLevels {
public:
    /// Reads the levels that are held. The terrain (a TentTerrain where levels are filtered)
    /// outlives it.
    HeightLevels(const Terrain& terrain, const HeightLevelsOptions& options);

    /// Takes what has been read since, and begins a new list of what is missing. Throws what a
    /// loader's thread has thrown: the terrain's error, which names the tile.
    void begin_frame();
    /// Has the tiles read that were found to be missing. Never waits.
    void request_missing();
    /// From now on nothing is missing: what is not there is read when it is asked for.
    void wait_for_tiles();

    /// Whether all these samples are in memory; those of their tiles that are not are missing.
    bool require(int level, const common::LevelRect& samples);
    /// Copies them, row by row. ContractError where one is not in memory.
    void copy(int level, const common::LevelRect& samples, std::vector<float>& heights);
    /// Of the finest level, bilinear; as long as its tile is missing, of the finest that is there.
    /// (x: column, y: row of the grid), inside of it.
    [[nodiscard]] double ground_height(const glm::dvec2& place);

    void pause() { loader_.pause(); }
    void resume() { loader_.resume(); }

    [[nodiscard]] std::size_t missing_tiles() const { return missing_.size(); }
    [[nodiscard]] int tiles_in_memory() const { return pool_.resident(); }
    [[nodiscard]] std::uint64_t tiles_read() const { return tiles_read_; }

private:
    [[nodiscard]] glm::ivec2 last_sample_of(int level) const;
    template <typename Visit>
    void for_each_tile(int level, const common::LevelRect& samples, const Visit& visit);
    [[nodiscard]] bool there(int level, const common::LevelRect& samples);
    /// From a sample of the level eastward, as many as lie one behind the other in memory.
    [[nodiscard]] std::span<const float> from(int level, glm::ivec2 sample);
    [[nodiscard]] bool require_tile(const TileId& tile);
    [[nodiscard]] TileId tile_at(int level, glm::ivec2 sample) const;
    [[nodiscard]] const std::vector<float>* find(const TileId& tile);
    bool store(common::LoadedTile&& loaded);
    void hold_coarse_levels();

    const Terrain& terrain_;
    HeightLevelsOptions options_;
    TilePyramid pyramid_;
    int first_held_ = 0;
    std::vector<HeightGrid> held_;  ///< from level first_held_ on
    common::TilePool pool_;
    std::vector<std::vector<float>> slots_;
    std::uint64_t frame_ = 1;
    std::vector<TileId> missing_;
    std::unordered_set<std::size_t> known_missing_;
    bool waits_ = false;
    std::uint64_t tiles_read_ = 0;
    common::TileLoader loader_;
};

}  // namespace lodbench::clipmap
