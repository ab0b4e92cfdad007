#include "picture/truth_panels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace lodbench::picture {
namespace {

constexpr int kMaxEnlarged = 640;  // pixels of a panel's longer side
constexpr int kMaxReduced = 800;
constexpr double kMaxStripAspect = 10;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// Beside the marks of the interface.
constexpr std::uint8_t kUncoveredMark = 128;

struct Mark {
    std::uint8_t bit;
    Rgb color;
    int least_size;  // pixels of the panel; a skirt covers areas and would hide errors beside it
};
// In the order in which they are painted: of several in one place the last is seen.
constexpr Mark kMarks[] = {{measure::kSkirtMark, kSkirtColor, 1},
                           {kUncoveredMark, kUncoveredColor, 5},
                           {measure::kSilhouetteMark, kSkyOrTerrainColor, 3},
                           {measure::kCrackMark, kCrackColor, 5}};

/// The worst of two errors: uncovered, then the larger, then nothing to compare.
float worse(float first, float second) {
    return std::fmax(first, second);
}

/// Calls visit(x, y, columns, rows) for each pixel (x, y) of the panel with the pixels of the
/// viewport that it stands for.
template <typename Visit>
void for_each_panel_pixel(const Viewport& viewport, const Zoom& zoom, const Visit& visit) {
    const auto source = [&](int position, int size) {
        const int begin = position / zoom.enlarge * zoom.reduce;
        return std::pair(begin, std::min(begin + zoom.reduce, size));
    };
    for (int y = 0; y < zoom.panel.height; ++y) {
        for (int x = 0; x < zoom.panel.width; ++x) {
            visit(x, y, source(x, viewport.width), source(y, viewport.height));
        }
    }
}

/// Cosine of the angle between each cell's normal and the light, 0..1; a plane has kFlatShade.
/// Heights are exaggerated until slopes of this terrain are seen.
constexpr double kFlatShade = std::numbers::sqrt2 / 2;
std::vector<double> hillshade(const TruthPicture& picture) {
    const int rows = picture.map_rows;
    const int columns = picture.map_columns;
    const glm::dvec2 cell =
        (picture.terrain.extent_max() - picture.terrain.extent_min()) / glm::dvec2(columns, rows);
    const auto height = [&](int row, int column) {
        return double(picture.map_height[std::size_t(row) * columns + column]);
    };
    const std::size_t count = std::size_t(rows) * columns;
    std::vector<glm::dvec2> slopes(count);  // rise per metre eastward and northward
    double sum = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const int west = std::max(column - 1, 0);
            const int east = std::min(column + 1, columns - 1);
            const int north = std::max(row - 1, 0);
            const int south = std::min(row + 1, rows - 1);
            const glm::dvec2 rise(height(row, east) - height(row, west),
                                  height(north, column) - height(south, column));
            const glm::dvec2 run =
                cell * glm::dvec2(std::max(east - west, 1), std::max(south - north, 1));
            const glm::dvec2 slope = rise / run;
            if (!std::isfinite(slope.x + slope.y)) continue;
            slopes[std::size_t(row) * columns + column] = slope;
            sum += glm::dot(slope, slope);
        }
    }
    constexpr double kTypicalSlope = 0.5;
    constexpr double kMaxExaggeration = 100;  // the ripples of a plain are not mountains
    const double typical = std::sqrt(sum / double(count));
    const double exaggeration =
        std::min(kTypicalSlope / std::max(typical, 1e-12), kMaxExaggeration);
    std::vector<double> shade(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-slopes[i] * exaggeration, 1.0));
        shade[i] = std::max(glm::dot(normal, glm::dvec3(-0.5, 0.5, kFlatShade)), 0.0);
    }
    return shade;
}

Rgb map_color(double shade, float error_px, double scale_px) {
    if (std::isinf(error_px)) return kUncoveredColor;
    if (std::isnan(error_px)) return srgb_from_oklab({0.45 + 0.45 * shade, 0, 0});
    Oklab color = error_oklab(error_px / scale_px);
    color.lightness += 0.2 * (shade - kFlatShade);
    return srgb_from_oklab(color);
}

}  // namespace

Zoom zoom_for(const Viewport& viewport) {
    const int longer = std::max(viewport.width, viewport.height);
    Zoom zoom;
    if (longer <= kMaxReduced) {
        zoom.enlarge = std::max(kMaxEnlarged / longer, 1);
    } else {
        zoom.reduce = (longer - 1) / kMaxReduced + 1;
    }
    const auto size = [&](int pixels) { return ((pixels - 1) / zoom.reduce + 1) * zoom.enlarge; };
    zoom.panel = {size(viewport.width), size(viewport.height)};
    return zoom;
}

Image color_panel(std::span<const std::uint8_t> rgb, const Viewport& viewport, const Zoom& zoom) {
    Image panel = Image::filled(zoom.panel.width, zoom.panel.height, {});
    for_each_panel_pixel(viewport, zoom, [&](int x, int y, auto columns, auto rows) {
        std::uint32_t sum[3] = {};
        std::uint32_t count = 0;
        for (int row = rows.first; row < rows.second; ++row) {
            for (int column = columns.first; column < columns.second; ++column, ++count) {
                const std::size_t i = (std::size_t(row) * viewport.width + column) * 3;
                for (int channel = 0; channel < 3; ++channel) sum[channel] += rgb[i + channel];
            }
        }
        const auto mean = [&](int channel) {
            return std::uint8_t((sum[channel] + count / 2) / count);
        };
        panel.set(x, y, {mean(0), mean(1), mean(2)});
    });
    return panel;
}

Image error_panel(const TruthPicture& picture, const Zoom& zoom) {
    const Viewport& viewport = picture.camera.viewport;
    Canvas canvas(zoom.panel.width, zoom.panel.height, kNothingColor);
    std::vector<std::uint8_t> marks(std::size_t(zoom.panel.width) * zoom.panel.height);
    Image colors = Image::filled(zoom.panel.width, zoom.panel.height, kNothingColor);
    for_each_panel_pixel(viewport, zoom, [&](int x, int y, auto columns, auto rows) {
        float error = kNothing;
        std::uint8_t bits = 0;
        for (int row = rows.first; row < rows.second; ++row) {
            for (int column = columns.first; column < columns.second; ++column) {
                const std::size_t i = std::size_t(row) * viewport.width + column;
                error = worse(error, picture.error_px[i]);
                bits |= picture.marks[i] &
                        (measure::kCrackMark | measure::kSkirtMark | measure::kSilhouetteMark);
            }
        }
        if (std::isinf(error)) bits |= kUncoveredMark;
        marks[std::size_t(y) * zoom.panel.width + x] = bits;
        if (!std::isnan(error)) colors.set(x, y, error_color(error / picture.scale_px));
    });
    canvas.blit(colors, 0, 0);
    for (const Mark& mark : kMarks) {
        const int grown =
            zoom.enlarge < mark.least_size ? (mark.least_size - zoom.enlarge + 1) / 2 : 0;
        for (int y = 0; y < zoom.panel.height; ++y) {
            for (int x = 0; x < zoom.panel.width; ++x) {
                if ((marks[std::size_t(y) * zoom.panel.width + x] & mark.bit) == 0) continue;
                canvas.fill({x - grown, y - grown, 2 * grown + 1, 2 * grown + 1}, mark.color);
            }
        }
    }
    return canvas.image();
}

glm::dvec2 MapFrame::pixel(const glm::dvec2& world) const {
    const glm::dvec2 offset = (world - extent_min) * pixels_per_metre;
    return {offset.x, height - offset.y};
}

MapFrame map_frame(const TerrainInfo& terrain, int max_width, int max_height) {
    const glm::dvec2 extent = terrain.extent_max() - terrain.extent_min();
    const double aspect = std::clamp(extent.x / extent.y, 1 / kMaxStripAspect, kMaxStripAspect);
    const double width = std::min(double(max_width), max_height * aspect);
    MapFrame frame;
    frame.extent_min = terrain.extent_min();
    frame.width = std::max(int(std::lround(width)), 1);
    frame.height = std::max(int(std::lround(width / aspect)), 1);
    frame.pixels_per_metre = glm::dvec2(frame.width, frame.height) / extent;
    return frame;
}

Image map_panel(const TruthPicture& picture, const MapFrame& frame) {
    const std::vector<double> shades = hillshade(picture);
    // The cells that a pixel touches, one at least: their worst error and mean shade.
    const auto cells = [](int pixel, int pixels, int count) {
        const auto begin = std::int64_t(pixel) * count / pixels;
        const auto end = (std::int64_t(pixel + 1) * count - 1) / pixels + 1;
        return std::pair(int(begin), int(std::max(end, begin + 1)));
    };
    Image panel = Image::filled(frame.width, frame.height, {});
    for (int y = 0; y < frame.height; ++y) {
        const auto [first_row, last_row] = cells(y, frame.height, picture.map_rows);
        for (int x = 0; x < frame.width; ++x) {
            const auto [first_column, last_column] = cells(x, frame.width, picture.map_columns);
            float error = kNothing;
            double shade = 0;
            for (int row = first_row; row < last_row; ++row) {
                for (int column = first_column; column < last_column; ++column) {
                    const std::size_t i = std::size_t(row) * picture.map_columns + column;
                    error = worse(error, picture.map_error_px[i]);
                    shade += shades[i];
                }
            }
            shade /= double(last_row - first_row) * (last_column - first_column);
            panel.set(x, y, map_color(shade, error, picture.scale_px));
        }
    }
    return panel;
}

double mean_height(const TruthPicture& picture) {
    double sum = 0;
    double count = 0;
    for (const float height : picture.map_height) {
        if (!std::isfinite(height)) continue;
        sum += height;
        ++count;
    }
    if (count > 0) return sum / count;
    return (double(picture.terrain.min_height) + picture.terrain.max_height) / 2;
}

std::vector<glm::dvec2> footprint(const Camera& camera, const TerrainInfo& terrain, double height) {
    const glm::dvec2 low = terrain.extent_min();
    const glm::dvec2 high = terrain.extent_max();
    std::vector<glm::dvec2> outline = {low, {high.x, low.y}, high, {low.x, high.y}};
    // In the plane z = height each plane of the frustum is a line; Sutherland and Hodgman 1974.
    for (const glm::dvec4& plane : camera.frustum_planes()) {
        const auto inside = [&](const glm::dvec2& p) {
            return glm::dot(glm::dvec3(plane), glm::dvec3(p, height) - camera.position) + plane.w;
        };
        std::vector<glm::dvec2> clipped;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const glm::dvec2& from = outline[i];
            const glm::dvec2& to = outline[(i + 1) % outline.size()];
            const double from_inside = inside(from);
            const double to_inside = inside(to);
            if (from_inside >= 0) clipped.push_back(from);
            if ((from_inside >= 0) != (to_inside >= 0)) {
                clipped.push_back(from + (to - from) * (from_inside / (from_inside - to_inside)));
            }
        }
        outline = std::move(clipped);
    }
    return outline;
}

}  // namespace lodbench::picture
