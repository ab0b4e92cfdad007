#include "run/flight_record.h"

#include <json/value.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "api/error.h"
#include "base/files.h"
#include "measure/needed_tiles.h"
#include "picture/png.h"
#include "results/json.h"
#include "run/flight_check.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

constexpr int kLargestMap = 512;  // pixels
// Screen errors for which the needed tiles are told.
constexpr std::array kTargetsPx = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0};
// Of the map's tone: what a plain has, and what the steepest slope takes from or adds to it.
constexpr double kPlainTone = 168;
constexpr double kToneRange = 120;

/// Every 2^l-th sample, row by row.
struct ThinnedGrid {
    int rows = 0, columns = 0;
    std::vector<float> heights;
};

/// As thin as leaves two samples a pixel along the longer side, so that a terrain on disk gives a
/// few of its tiles for a map and stays there.
ThinnedGrid thinned(const Terrain& terrain, int pixels) {
    const TerrainInfo& info = terrain.info();
    int level = 0;
    while ((std::max(info.rows, info.columns) - 1) >> (level + 1) >= 2 * pixels) ++level;
    ThinnedGrid grid{((info.rows - 1) >> level) + 1, ((info.columns - 1) >> level) + 1, {}};
    grid.heights.resize(std::size_t(grid.rows) * std::size_t(grid.columns));
    const TilePyramid pyramid = terrain.tiles();
    std::vector<float> tile(kTileSampleCount);
    for (int row = 0; row < pyramid.rows(level); ++row) {
        for (int column = 0; column < pyramid.columns(level); ++column) {
            terrain.read_tile({level, row, column}, tile);
            const int top = row * kTileCells, left = column * kTileCells;
            const int width = std::min(kTileSamples, grid.columns - left);
            for (int y = 0; y < std::min(kTileSamples, grid.rows - top); ++y) {
                std::copy_n(&tile[std::size_t(y * kTileSamples)], width,
                            &grid.heights[std::size_t(top + y) * std::size_t(grid.columns) +
                                          std::size_t(left)]);
            }
        }
    }
    return grid;
}

/// The mean height of the samples below each pixel, row by row.
std::vector<double> mean_heights(const ThinnedGrid& grid, int width, int height) {
    std::vector<double> means;
    means.reserve(std::size_t(width) * std::size_t(height));
    const auto first = [](int pixel, int pixels, int samples) {
        return int(std::int64_t(pixel) * samples / pixels);
    };
    for (int y = 0; y < height; ++y) {
        const int top = first(y, height, grid.rows);
        const int bottom = std::max(first(y + 1, height, grid.rows), top + 1);
        for (int x = 0; x < width; ++x) {
            const int left = first(x, width, grid.columns);
            const int right = std::max(first(x + 1, width, grid.columns), left + 1);
            double sum = 0;
            for (int row = top; row < bottom; ++row) {
                const float* const samples =
                    &grid.heights[std::size_t(row) * std::size_t(grid.columns)];
                for (int column = left; column < right; ++column) sum += double(samples[column]);
            }
            means.push_back(sum / (double(bottom - top) * double(right - left)));
        }
    }
    return means;
}

Json::Value vector_json(const glm::dvec3& vector) {
    Json::Value json = Json::arrayValue;
    for (int i = 0; i < 3; ++i) json.append(vector[i]);
    return json;
}

Json::Value pair_json(double x, double y) {
    Json::Value json = Json::arrayValue;
    json.append(x);
    json.append(y);
    return json;
}

/// Of a flight that was recorded before; none where its file is damaged, which the report says.
std::vector<std::string> recorded_warnings(const fs::path& file) {
    std::vector<std::string> warnings;
    try {
        const Json::Value json = results::parse_json(base::read_text(file), file.string());
        for (const Json::Value& warning : results::get_array(json, "warnings", file.string())) {
            warnings.push_back(warning.asString());
        }
    } catch (const InputError&) {
        return {};
    } catch (const Json::Exception&) {
        return {};
    }
    return warnings;
}

}  // namespace

picture::Image hillshade(const Terrain& terrain, int largest) {
    const TerrainInfo& info = terrain.info();
    const double extent_x = info.spacing.x * (info.columns - 1);
    const double extent_y = info.spacing.y * (info.rows - 1);
    const double scale = double(largest) / std::max(extent_x, extent_y);
    const int width = std::clamp(int(std::lround(extent_x * scale)), 1, info.columns);
    const int height = std::clamp(int(std::lround(extent_y * scale)), 1, info.rows);
    const std::vector<double> heights = mean_heights(thinned(terrain, largest), width, height);
    const auto at = [&](int x, int y) {
        return heights[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) +
                       std::size_t(std::clamp(x, 0, width - 1))];
    };
    // The slope towards the light, over the steepest there is on the whole but for one in fifty:
    // flat and alpine terrains alike show their forms.
    std::vector<double> slopes;
    slopes.reserve(heights.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double east = (at(x + 1, y) - at(x - 1, y)) / (2 * extent_x / width);
            const double south = (at(x, y + 1) - at(x, y - 1)) / (2 * extent_y / height);
            slopes.push_back(east + south);
        }
    }
    std::vector<double> sizes(slopes.size());
    std::ranges::transform(slopes, sizes.begin(), [](double slope) { return std::abs(slope); });
    const auto steep = sizes.begin() + std::ptrdiff_t(sizes.size() * 49 / 50);
    std::ranges::nth_element(sizes, steep);
    const double unit = *steep > 0 ? *steep : 1;
    picture::Image image = picture::Image::filled(width, height, {});
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        const double tone = kPlainTone + kToneRange * std::tanh(slopes[i] / unit);
        const auto level = std::uint8_t(std::clamp(std::lround(tone), 0L, 255L));
        image.set(int(i % std::size_t(width)), int(i / std::size_t(width)), {level, level, level});
    }
    return image;
}

std::vector<std::string> record_flight(const fs::path& out, const std::string& name,
                                       const Terrain& terrain, int frames,
                                       const std::function<Camera(int)>& camera_at) {
    const fs::path file = out / "flights" / (name + ".json");
    std::error_code ignored;
    if (fs::exists(file, ignored)) return recorded_warnings(file);
    fs::create_directories(file.parent_path(), ignored);
    const picture::Image map = hillshade(terrain, kLargestMap);
    picture::write_png(out / "flights" / (name + "__hillshade.png"), map.width, map.height,
                       map.rgb);

    const TerrainInfo& info = terrain.info();
    Json::Value json;
    json["schema_version"] = results::kSchemaVersion;
    json["scenario"] = name;
    json["terrain"] = info.name;
    json["rows"] = info.rows;
    json["columns"] = info.columns;
    json["spacing"] = pair_json(info.spacing.x, info.spacing.y);
    json["south_west"] = pair_json(info.extent_min().x, info.extent_min().y);
    json["north_east"] = pair_json(info.extent_max().x, info.extent_max().y);
    json["min_height"] = double(info.min_height);
    json["max_height"] = double(info.max_height);
    json["positions"] = Json::arrayValue;
    json["directions"] = Json::arrayValue;
    measure::NeededTiles needed(terrain, {kTargetsPx.begin(), kTargetsPx.end()});
    FlightCheck check(terrain);
    for (int frame = 0; frame < frames; ++frame) {
        const Camera camera = camera_at(frame);
        check.add(camera);
        json["positions"].append(vector_json(camera.position));
        json["directions"].append(vector_json(camera.forward()));
        needed.add(camera);
    }
    json["needed"] = Json::arrayValue;
    for (const measure::TileNeed& need : needed.needs()) {
        Json::Value entry;
        entry["target_px"] = need.target_px;
        entry["tiles"] = Json::UInt64(need.tiles);
        entry["samples"] = Json::UInt64(need.samples());
        entry["most_tiles_in_a_frame"] = Json::UInt64(need.most_in_a_frame);
        json["needed"].append(entry);
    }
    const std::vector<std::string> warnings = check.warnings(name);
    json["warnings"] = results::array_of(warnings);
    base::write_whole(file, results::seal(json) + "\n");
    return warnings;
}

}  // namespace lodbench::run
