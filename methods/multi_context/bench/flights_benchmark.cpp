// Which altitude, pitch and lens give multi-context the triangles of Yusuf, Mostafa, Elarif 2014,
// section 4, none of which the paper says: 1,198,080 at the start, over the middle of an edge, and
// 300,000 at the centre; 640 x 480, delta = 1, k = 33.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "benchmarks.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "multi_context/block_tree.h"
#include "multi_context/errors_pass.h"
#include "platform/context.h"

namespace lodbench::benchmarks {
namespace {

using multi_context::BlockErrors;
using multi_context::ErrorsPass;
using multi_context::HeightRanges;
using multi_context::Layout;
using multi_context::Selection;
using multi_context::Traversal;

constexpr int kSide = 33;  ///< vertices of a block
constexpr double kTrianglesOfABlock = 2.0 * (kSide - 1) * (kSide - 1);
constexpr std::array<double, 2> kPaper = {1198080, 300000};

/// Metres above the highest ground on the way; degrees.
constexpr double kAltitudes[] = {100, 250, 500, 1000, 2000, 3000, 5000, 10000, 30000, 77000};
constexpr double kPitches[] = {0, -5, -10, -15, -20, -30, -45, -60, -75};
constexpr double kFieldsOfView[] = {15, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90, 100, 110, 120};

/// Metres: of the samples in the middle from south to north.
double highest_on_the_way(const Terrain& terrain) {
    const TerrainInfo& info = terrain.info();
    std::vector<float> heights(std::size_t(info.rows));
    terrain.read({0, info.columns / 2, info.rows, 1}, heights);
    return *std::max_element(heights.begin(), heights.end());
}

/// Over the middle of the southern edge (0) or the centre (1), looking north. `height` in metres.
Camera camera_of(const TerrainInfo& info, int place, double height, double pitch, double fov) {
    constexpr double kDegree = 0.017453292519943295;
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    Camera camera;
    camera.position = {info.origin.x + 0.5 * size.x, info.origin.y + 0.5 * place * size.y, height};
    camera.orientation =
        Camera::look({0, std::cos(pitch * kDegree), std::sin(pitch * kDegree)}, {0, 0, 1});
    camera.vertical_fov = fov * kDegree;
    camera.near_plane = 10;
    return camera;
}

struct Candidate {
    double altitude, pitch, fov;
    std::array<double, 2> triangles;
    /// How many times too many or too few, both places together: the length of the logarithms.
    [[nodiscard]] double distance() const {
        double squares = 0;
        for (std::size_t i = 0; i < kPaper.size(); ++i) {
            const double off = std::log(std::max(triangles[i], 1.0) / kPaper[i]);
            squares += off * off;
        }
        return std::sqrt(squares);
    }
};

}  // namespace

void flights_benchmark(const Options& options) {
    const std::shared_ptr<const terrain::HeightField> terrain =
        terrain::load_terrain(options.source());
    const TerrainInfo& info = terrain->info();
    const platform::Context context;
    gl::Device device;
    gl::Texture heights(device, "heights", GL_TEXTURE_2D, GL_R32F, info.columns, info.rows);
    const Layout layout(info.rows, info.columns, kSide);
    const HeightRanges ranges(*terrain, layout, [&](const SampleRect& rect, auto strip) {
        heights.write(0, 0, rect.row, rect.columns, rect.rows, GL_RED, GL_FLOAT, strip.data());
    });
    glFinish();
    const double highest = highest_on_the_way(*terrain);
    ErrorsPass pass(device, heights, info, {.k = kSide});
    fmt::print(
        "flights, {}, {} x {} samples, {} m apart, highest ground on the way {:.0f} m: {} "
        "altitudes, {} "
        "pitches, {} lenses\n",
        info.name, info.columns, info.rows, info.spacing.x, highest, std::size(kAltitudes),
        std::size(kPitches), std::size(kFieldsOfView));
    std::vector<Candidate> candidates;
    for (const double altitude : kAltitudes) {
        for (const double pitch : kPitches) {
            std::vector<Candidate> by_lens;
            for (const double fov : kFieldsOfView) by_lens.push_back({altitude, pitch, fov, {}});
            for (int place = 0; place < 2; ++place) {
                // Errors grow with lambda alone, so that one pass serves all lenses, each with a
                // tolerance of its own.
                const Camera of_pass = camera_of(info, place, highest + altitude, pitch, 60);
                BlockErrors errors;
                pass.run(of_pass, errors);
                for (Candidate& candidate : by_lens) {
                    const Camera camera =
                        camera_of(info, place, highest + altitude, pitch, candidate.fov);
                    Selection selection;
                    const auto delta = float(of_pass.lambda() / camera.lambda());
                    Traversal(info, layout, ranges, errors, delta, camera).select(selection);
                    candidate.triangles[std::size_t(place)] =
                        kTrianglesOfABlock * double(selection.blocks.size());
                }
            }
            candidates.insert(candidates.end(), by_lens.begin(), by_lens.end());
        }
    }
    const auto nearer = [](const Candidate& a, const Candidate& b) {
        return a.distance() < b.distance();
    };
    std::sort(candidates.begin(), candidates.end(), nearer);
    const auto print = [](const Candidate& c) {
        fmt::print("  {:8.0f} {:6.0f} {:5.0f} | {:9.0f} {:5.2f} | {:9.0f} {:5.2f}\n", c.altitude,
                   c.pitch, c.fov, c.triangles[0], c.triangles[0] / kPaper[0], c.triangles[1],
                   c.triangles[1] / kPaper[1]);
    };
    fmt::print("  metres above it, pitch, lens | start, of the paper's | centre, likewise\n");
    for (std::size_t i = 0; i < std::min(candidates.size(), std::size_t(12)); ++i) {
        print(candidates[i]);
    }
    const auto most = std::max_element(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.triangles[0] < b.triangles[0]; });
    fmt::print("  most at the start:\n");
    print(*most);
}

}  // namespace lodbench::benchmarks
