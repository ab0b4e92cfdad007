#pragma once
// A terrain in memory, and where terrains come from.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "terrain/tile_summaries.h"
#include "terrain/whole_terrain.h"

namespace lodbench::terrain {

/// What every terrain must be. Throws InputError for a grid under 2 x 2, a spacing that is not
/// positive and finite, or an origin that is not finite.
void check_grid(const TerrainInfo& info);
/// Throws the InputError for a height that is not finite.
[[noreturn]] void refuse_height(const TerrainInfo& info, std::int64_t row, std::int64_t column,
                                float height);

/// A height field held in memory, row by row, row 0 the north edge. Negative zeros become
/// positive ones, so that equal heights have equal bits.
class HeightField final : public WholeTerrain {
public:
    /// `info` needs name, rows, columns, spacing, origin, void_count; the height range and the
    /// checksum are computed. Throws InputError for a grid under 2 x 2, a spacing that is not
    /// positive and finite, or a height that is not finite (naming row, column and value);
    /// ContractError where the number of heights is not rows * columns.
    HeightField(TerrainInfo info, std::vector<float> heights);
    [[nodiscard]] std::span<const float> samples() const override { return heights_; }

private:
    void copy_samples(const SampleRect& rect, std::span<float> heights) const override;
    void copy_tile(const TileId& tile, std::span<float> heights) const override;
    [[nodiscard]] TileSummary find_summary(const TileId& tile) const override;
    std::vector<float> heights_;
    mutable std::once_flag summarised_;
    mutable std::unique_ptr<TileSummaries> summaries_;
};

/// A larger terrain from a smaller one: samples of the result between two of the source, and what
/// is added there.
struct Upsampling {
    int factor = 2;                   ///< 1 to 64
    double fractal_amplitude = 0;     ///< metres, >= 0; above 0 the factor is a power of two
    std::uint64_t seed = 1;           ///< of the fractal
    std::optional<int> rows = {};     ///< of the result, kept from the north; all if empty
    std::optional<int> columns = {};  ///< kept from the west
};

/// What names a terrain, in a scenario or on the command line: either a file or a synthetic form.
/// Everything optional overrides what the file (or its sidecar) says.
struct TerrainSource {
    std::filesystem::path file;  ///< raster; empty for a synthetic terrain
    std::string synthetic;       ///< plane, ramp, sphere-cap, bump, step, ridged; empty for a file
    int rows = 1025;             ///< synthetic only
    int columns = 1025;          ///< synthetic only
    std::uint64_t seed = 1;      ///< synthetic only
    std::map<std::string, double> shape;  ///< synthetic only: parameters of the form, in metres

    std::optional<double> spacing_x, spacing_y;  ///< metres
    std::optional<double> vertical_scale;        ///< metres per unit of the file
    std::optional<double> vertical_offset;       ///< metres, added after scaling
    std::optional<double> origin_x, origin_y;    ///< metres, of the south-west sample
    std::optional<double> no_data;               ///< in units of the file
    bool cold = false;  ///< a store's tiles come from the disk, not from what the system holds
    /// A store only: nothing holds the whole of it in memory.
    bool out_of_core = false;
    /// Made larger once it is read, in memory; what is overridden above is that of the smaller one.
    std::optional<Upsampling> upsampling;
    std::string where;  ///< "scenario.toml:12", put in front of messages; may be empty
};

/// Reads or makes the terrain. Throws InputError with file, value and remedy.
[[nodiscard]] std::unique_ptr<HeightField> load_terrain(const TerrainSource& source);

}  // namespace lodbench::terrain
