#pragma once
// The pyramid of means of a terrain that does not fit into memory: made in one pass over its rows,
// kept in a file. (Livny et al. 2006, section 3.4.)

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "api/terrain.h"
#include "persistent_grid/cache_file.h"
#include "persistent_grid/pyramid.h"

namespace lodbench::persistent_grid {

/// A terrain whose coarser tiles hold means instead of every 2^l-th sample. Texel k of level l is
/// the mean that `half_resolution` gives, to the bit; tile (row, column) of level l begins at texel
/// (64 row, 64 column) and takes 65 x 65 of them, the last ones repeated beyond the edge. Level 0
/// is the terrain's own. Levels coarser than the coarsest that has tiles are in memory (`small`).
///
/// The file is named after the terrain's checksum and size. It is read through, and held against
/// the checksums in it, when it is opened: one that is damaged, cut short, of another terrain or
/// another version is made again.
class MeanPyramid final : public Terrain {
public:
    /// Takes the pyramid from the first of `folders` that has it, else makes it in the first that
    /// can be written to. Without folders, and for a terrain without a checksum, it is made in a
    /// file that has no name. The terrain outlives the pyramid. Throws EnvironmentError, saying
    /// what was tried, where no folder can be written to or the disk is full; TerrainError as
    /// reading the terrain does.
    MeanPyramid(const Terrain& terrain, const std::vector<std::filesystem::path>& folders);

    /// It was there already.
    [[nodiscard]] bool was_cached() const { return cached_; }
    /// Of the file; empty where it has no name.
    [[nodiscard]] const std::filesystem::path& file() const { return path_; }
    [[nodiscard]] std::uint64_t file_bytes() const;
    /// Levels down to one texel; those from `tiles().levels()` on are `small`.
    [[nodiscard]] int level_count() const { return persistent_grid::level_count(info_); }
    [[nodiscard]] const Level& small(int level) const {
        return small_[std::size_t(level - tiles().levels())];
    }
    /// Of the terrain and of the pyramid's file.
    [[nodiscard]] std::uint64_t bytes_read() const override;

private:
    void copy_samples(const SampleRect& rect, std::span<float> heights) const override;
    void copy_tile(const TileId& tile, std::span<float> heights) const override;
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override;
    /// Tiles of level 1 and coarser come level upon level, each row by row.
    [[nodiscard]] std::size_t place_of(const TileId& tile) const;
    [[nodiscard]] std::uint64_t offset_of(std::size_t place) const;
    bool find(const std::vector<std::filesystem::path>& folders, const std::string& name);
    bool open(const std::filesystem::path& path);
    [[nodiscard]] bool is_whole();
    void make_in(std::vector<std::filesystem::path> folders, const std::string& name);
    void make(int descriptor);
    void read_small();

    const Terrain& terrain_;
    std::size_t tile_count_ = 0;  ///< of level 1 and coarser
    std::filesystem::path path_;
    OpenFile file_;
    bool cached_ = false;
    std::vector<std::uint64_t> checksums_;  ///< by place
    std::vector<Level> small_;
    mutable std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace lodbench::persistent_grid
