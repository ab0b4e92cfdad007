#pragma once
// Clip windows: of every level of the pyramid a square about the viewpoint, all of one size, in one
// texture (Livny et al. 2006, section 4, figures 12, 13 and 15). What a move brings in is written,
// L by L: an F over the texture.

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "common/toroidal_window.h"
#include "persistent_grid/mean_pyramid.h"
#include "persistent_grid/tile_shelf.h"

namespace lodbench::persistent_grid {

struct ClipOptions {
    int texels = 512;          ///< along a window's edge, a power of two, >= 64
    int lines_per_frame = 64;  ///< rows and columns that `update` writes at most, >= 1
    bool entire = false;       ///< writes all windows whole in every frame, whatever they hold
    int loader_threads = 2;    ///< >= 1
};

/// What the last `update` or `load` did.
struct ClipCounts {
    std::int64_t texels = 0;   ///< written
    std::int64_t missing = 0;  ///< texels that the windows lack afterwards
    int lines = 0;             ///< rows and columns written
    int windows_behind = 0;    ///< windows that lack some
    double seconds = 0;        ///< wall clock, all together
    double writing_s = 0;      ///< of it, in `write`
};

/// The windows are filled by the host's `write`, which owns the texture. Level l stands where the
/// viewpoint does, as far as the terrain goes: at its border the windows stop. A window beyond the
/// last row or column of its level has the edge's heights there.
class ClipWindows {
public:
    /// Where in the texture, how many columns and rows, and their heights row by row.
    using Write =
        std::function<void(glm::ivec2 texel, glm::ivec2 size, std::span<const float> heights)>;

    /// The pyramid outlives the windows.
    ClipWindows(const MeanPyramid& pyramid, const ClipOptions& options);

    /// Columns and rows of the texture for so many windows: as square as whole windows make it.
    [[nodiscard]] static glm::ivec2 texture_size(int levels, int texels) {
        const int columns = int(std::ceil(std::sqrt(double(levels))));
        return texels * glm::ivec2(columns, (levels + columns - 1) / columns);
    }
    [[nodiscard]] int level_count() const { return int(windows_.size()); }
    [[nodiscard]] glm::ivec2 texture_size() const { return texture_size_; }
    [[nodiscard]] glm::ivec2 corner(int level) const;
    /// What the texture holds of a level; empty at first.
    [[nodiscard]] const common::LevelRect& held(int level) const {
        return windows_[std::size_t(level)].held();
    }
    [[nodiscard]] const common::LevelRect& target(int level) const {
        return windows_[std::size_t(level)].target();
    }

    /// Reads and writes the windows that hold their whole level; the coarsest is one. To be called
    /// once, before all else.
    void start(const Write& write);
    /// Moves the windows to a place in samples (x: columns, y: rows) and writes, coarsest first,
    /// what has been read of what they lack. Never waits. Throws TerrainError.
    void update(const glm::dvec2& place, const Write& write);
    /// The same, waiting until nothing is missing.
    void load(const glm::dvec2& place, const Write& write);

    void pause() { shelf_.pause(); }
    void resume() { shelf_.resume(); }
    [[nodiscard]] const ClipCounts& counts() const { return counts_; }

private:
    [[nodiscard]] bool holds_all(int level) const;
    void move_to(const glm::dvec2& place);
    /// Asks for the tiles under the windows of the levels, and one more around each.
    void want(bool whole_levels);
    void fill(int most_lines, const Write& write);
    /// Returns the lines written.
    int fill_level(int level, int most_lines, const Write& write);
    /// The first and the last tile (x: column, y: row) of what a level has of these texels.
    struct TileRange {
        glm::ivec2 first{0}, last{-1};
        friend bool operator==(const TileRange&, const TileRange&) = default;
    };
    [[nodiscard]] TileRange tiles_under(int level, const common::LevelRect& texels) const;
    [[nodiscard]] bool is_here(int level, const common::LevelRect& texels) const;
    [[nodiscard]] std::vector<float> gather(int level, const common::LevelRect& texels) const;

    const MeanPyramid& pyramid_;
    TilePyramid tiles_;
    ClipOptions options_;
    glm::ivec2 texture_size_{0};
    std::vector<common::ToroidalWindow> windows_;
    std::vector<TileRange> wanted_;  ///< of each level, when tiles were asked for last
    TileShelf shelf_;
    ClipCounts counts_;
};

}  // namespace lodbench::persistent_grid
