// What `dss` costs on the CPU, how fat its strips' triangles are, and what the strips themselves
// cost in error.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "benchmarks.h"
#include "stitching_strips/strip_builder.h"
#include "stitching_strips/tess_coordinates.h"
#include "terrain/load_terrain.h"

namespace lodbench::benchmarks {
namespace {

using namespace stitching_strips;

/// Along a diagonal over the terrain, 200 m above its highest point, looking ahead and down.
std::vector<Camera> flight(const TerrainInfo& info, int frames) {
    std::vector<Camera> cameras;
    const glm::dvec2 extent = info.extent_max() - info.extent_min();
    for (int i = 0; i < frames; ++i) {
        Camera camera;
        camera.viewport = {1280, 960};
        camera.position = {info.origin + extent * (0.1 + 0.6 * i / frames), info.max_height + 200};
        camera.orientation = Camera::look({1, 0.8, -0.35});
        cameras.push_back(camera);
    }
    return cameras;
}

/// Of all threads of the process: what other programs take of the processors is not in it.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

void preprocess(const Terrain& terrain, const Options& options) {
    const int all =
        int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    const auto print = [&](const char* what, int threads, const auto& work) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        std::size_t(threads));
        double best = 1e300, least_processor = 1e300;
        for (int i = 0; i < options.repetitions; ++i) {
            const double before = processor_seconds();
            best = std::min(best, seconds_of(work));
            least_processor = std::min(least_processor, processor_seconds() - before);
        }
        fmt::print("  {:<38} {:2} thread(s)  {:7.3f} s, of processors {:7.3f} s\n", what, threads,
                   best, least_processor);
        std::fflush(stdout);
    };
    const GroundHeights ground(terrain);
    print("reading", all, [&] { GroundHeights again(terrain); });
    for (const ErrorKind kind : {ErrorKind::average, ErrorKind::max}) {
        const char* what = kind == ErrorKind::average ? "average errors, bounds of the ground"
                                                      : "greatest errors, the same";
        for (const int threads : {1, all}) {
            print(what, threads, [&] { BlockTree tree(terrain, ground, 1, kind); });
            if (all == 1) break;
        }
    }
}

void print_rising_steps(const BlockTree& tree) {
    std::size_t steps = 0, rising = 0;
    for (int number = kRoot; number + 1 < int(tree.size()); ++number) {
        if (!tree.block(number).on_ground) continue;
        const BlockErrors& errors = tree.errors(number);
        for (std::size_t i = 0; i + 1 < errors.size(); ++i, ++steps) {
            if (errors[i + 1] > errors[i]) ++rising;
        }
    }
    fmt::print("  errors that rise with the factor: {:.2f} % of {} steps\n",
               100.0 * double(rising) / double(steps), steps);
}

/// Columns and rows from the south, and metres.
std::vector<glm::dvec3> places_of(const BlockTree& tree, const BlockCut& cut,
                                  const GroundHeights& ground,
                                  std::span<const StripVertex> vertices) {
    std::vector<glm::dvec3> places;
    places.reserve(vertices.size());
    for (const StripVertex& vertex : vertices) {
        const Leaf& leaf = cut.leaves()[vertex.leaf];
        const Square& square = tree.block(leaf.block).square;
        const float along = tess_coordinate(int(vertex.place / 4), leaf.factor);
        const std::array<glm::vec2, 4> at = {glm::vec2(along, 0), glm::vec2(1, along),
                                             glm::vec2(along, 1), glm::vec2(0, along)};
        const glm::vec2 place =
            glm::vec2(square.corner) + float(square.side) * at[vertex.place % 4];
        places.emplace_back(glm::dvec2(place), double(ground.at(place)));
    }
    return places;
}

/// Degrees; 0 where two corners are one.
double least_angle(const std::array<glm::dvec2, 3>& corners) {
    double least = 180;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 a = corners[(i + 1) % 3] - corners[i],
                         b = corners[(i + 2) % 3] - corners[i];
        if (a == glm::dvec2(0) || b == glm::dvec2(0)) return 0;
        const double cosine = glm::dot(a, b) / (glm::length(a) * glm::length(b));
        least = std::min(least, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    return least * 180 / std::acos(-1.0);
}

/// Of figure 8b: one vertex of a side after one of the other, what is left over to the last one.
/// `left`, `right`: places in plan.
void add_sequential_angles(std::span<const glm::dvec3> left, std::span<const glm::dvec3> right,
                           std::vector<double>& angles) {
    std::size_t l = 0, r = 0;
    while (l + 1 < left.size() || r + 1 < right.size()) {
        const bool from_left = r + 1 == right.size() || (l + 1 < left.size() && l <= r);
        const glm::dvec3& apex = from_left ? left[l + 1] : right[r + 1];
        angles.push_back(
            least_angle({glm::dvec2(left[l]), glm::dvec2(right[r]), glm::dvec2(apex)}));
        ++(from_left ? l : r);
    }
}

void print_distribution(const char* what, std::vector<double> values, const char* unit) {
    if (values.empty()) return;
    std::ranges::sort(values);
    const auto at = [&](double share) {
        return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
    };
    fmt::print(
        "  {:<38} P1 {:8.3f}  P10 {:8.3f}  median {:8.3f}  P90 {:8.3f}  P99.9 {:8.3f}  max "
        "{:8.3f} {}\n",
        what, at(0.01), at(0.1), at(0.5), at(0.9), at(0.999), values.back(), unit);
}

void construct(const BlockTree& tree, const TerrainInfo& info, const Options& options) {
    const std::vector<Camera> cameras = flight(info, options.frames);
    for (const double tau : {0.25, 1.0, 4.0}) {
        for (const int threads : {1, 0}) {
            BlockCut cut(tree);
            StripBuilder builder(tree, threads);
            double best = 0, best_of_core = 0, update_share = 0, triangles = 0;
            for (int repetition = 0; repetition <= options.repetitions; ++repetition) {
                double building = 0, updating = 0, processor = 0;
                triangles = 0;
                for (const Camera& camera : cameras) {
                    updating += seconds_of([&] { cut.update(BlockMetric({.tau = tau}, camera)); });
                    const double before = processor_seconds();
                    building += seconds_of([&] { builder.build(cut, std::nullopt); });
                    processor += processor_seconds() - before;
                    triangles += double(builder.strip_triangles());
                }
                if (repetition == 0) continue;  // touches the memory for the first time
                best_of_core = std::max(best_of_core, triangles / processor);
                if (triangles / building <= best) continue;
                best = triangles / building;
                update_share = updating / (updating + building);
            }
            fmt::print(
                "  tau {:<5} {:<11} {:9.0f} triangles a frame  {:6.1f} M triangles/s, {:6.1f} M of "
                "a "
                "core's second  update {:4.1f} % of update and strips\n",
                tau, threads == 1 ? "one thread" : "all threads",
                triangles / double(cameras.size()), best / 1e6, best_of_core / 1e6,
                100 * update_share);
            std::fflush(stdout);
        }
    }
}

/// The fatness of triangles, merged and sequential.
void shapes(const BlockTree& tree, const GroundHeights& ground, const TerrainInfo& info,
            const Options& options) {
    std::vector<double> merged, sequential;
    BlockCut cut(tree);
    StripBuilder builder(tree, 0);
    for (const Camera& camera : flight(info, options.frames)) {
        cut.update(BlockMetric({.tau = 0.5}, camera));
        builder.build(cut, std::nullopt);
        const auto places = places_of(tree, cut, ground, builder.vertices());
        const auto indices = builder.indices().first(3 * builder.strip_triangles());
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            merged.push_back(
                least_angle({glm::dvec2(places[indices[i]]), glm::dvec2(places[indices[i + 1]]),
                             glm::dvec2(places[indices[i + 2]])}));
        }
        for (std::size_t strip = 0; strip < builder.strip_count(); ++strip) {
            const auto [left, right] = builder.sides(strip);
            add_sequential_angles(std::span(places).subspan(left.first, left.count),
                                  std::span(places).subspan(right.first, right.count), sequential);
        }
    }
    print_distribution("least angle, by middles of segments", std::move(merged), "degrees");
    print_distribution("least angle, sequential", std::move(sequential), "degrees");
}

/// Pixels between a true sample and the surface above or below it, as a camera sees them.
class PixelErrors {
public:
    PixelErrors(const TerrainInfo& info, const GroundHeights& ground, const Camera& camera)
        : info_(info), ground_(ground), camera_(camera) {}

    void add(std::vector<double>& errors, glm::ivec2 sample, double surface) const {
        const glm::dvec2 plan = info_.origin + info_.spacing * glm::dvec2(sample);
        const auto truth = camera_.project({plan, double(ground_.at(sample.x, sample.y))});
        const auto shown = camera_.project({plan, surface});
        if (!truth || !shown || truth->x < 0 || truth->y < 0 || truth->x > camera_.viewport.width ||
            truth->y > camera_.viewport.height) {
            return;
        }
        errors.push_back(glm::length(*truth - *shown));
    }
    /// Of the samples in a triangle, its border included.
    void add(std::vector<double>& errors, const std::array<glm::dvec3, 3>& corners) const {
        const glm::dvec2 a(corners[0]), b(corners[1]), c(corners[2]);
        const auto cross = [](glm::dvec2 u, glm::dvec2 v) { return u.x * v.y - u.y * v.x; };
        const double twice = cross(b - a, c - a);
        if (twice <= 0) return;
        const glm::ivec2 low(glm::max(glm::ceil(glm::min(a, glm::min(b, c))), glm::dvec2(0)));
        const glm::ivec2 high(glm::min(glm::floor(glm::max(a, glm::max(b, c))),
                                       glm::dvec2(ground_.columns() - 1, ground_.rows() - 1)));
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                const glm::dvec2 at(x, y);
                const double of_b = cross(at - a, c - a) / twice,
                             of_c = cross(b - a, at - a) / twice;
                if (of_b < 0 || of_c < 0 || of_b + of_c > 1) continue;
                add(errors, {x, y},
                    corners[0].z + of_b * (corners[1].z - corners[0].z) +
                        of_c * (corners[2].z - corners[0].z));
            }
        }
    }

private:
    const TerrainInfo& info_;
    const GroundHeights& ground_;
    const Camera& camera_;
};

/// A block as it is tessellated.
void add_block(const PixelErrors& pixels, const GroundHeights& ground, const Square& square,
               float factor, std::vector<double>& errors) {
    const std::vector<float> places = tess_coordinates(factor);
    const auto segments = int(places.size()) - 1;
    const auto vertex = [&](int i, int j) {
        const glm::vec2 place =
            glm::vec2(square.corner) +
            float(square.side) * glm::vec2(places[std::size_t(i)], places[std::size_t(j)]);
        return glm::dvec3(glm::dvec2(place), double(ground.at(place)));
    };
    for (int j = 0; j < segments; ++j) {
        for (int i = 0; i < segments; ++i) {
            const glm::dvec3 south_west = vertex(i, j), south_east = vertex(i + 1, j),
                             north_west = vertex(i, j + 1), north_east = vertex(i + 1, j + 1);
            if (diagonal_ascends(i, j, segments)) {
                pixels.add(errors, {south_west, south_east, north_east});
                pixels.add(errors, {south_west, north_east, north_west});
            } else {
                pixels.add(errors, {south_west, south_east, north_west});
                pixels.add(errors, {south_east, north_east, north_west});
            }
        }
    }
}

/// Strips are outside of the error metric: what they show, beside what blocks do.
void own_error(const BlockTree& tree, const GroundHeights& ground, const TerrainInfo& info,
               const Options& options) {
    std::vector<double> of_strips, of_blocks;
    BlockCut cut(tree);
    StripBuilder builder(tree, 0);
    for (const Camera& camera : flight(info, std::min(options.frames, 4))) {
        const PixelErrors pixels(info, ground, camera);
        cut.update(BlockMetric({.tau = 0.25}, camera));
        builder.build(cut, std::nullopt);
        const auto places = places_of(tree, cut, ground, builder.vertices());
        const auto indices = builder.indices();
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            pixels.add(of_strips,
                       {places[indices[i]], places[indices[i + 1]], places[indices[i + 2]]});
        }
        for (const Leaf& leaf : cut.leaves()) {
            add_block(pixels, ground, tree.block(leaf.block).square, leaf.factor, of_blocks);
        }
    }
    print_distribution("error of blocks at tau 0.25", std::move(of_blocks), "px");
    print_distribution("error of strips at tau 0.25", std::move(of_strips), "px");
}

}  // namespace

void strips_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> terrain = terrain::load_terrain(options.source());
    const TerrainInfo& info = terrain->info();
    fmt::print("dss, {} x {} samples, heights {:.0f} .. {:.0f} m: preprocessing\n", info.rows,
               info.columns, info.min_height, info.max_height);
    preprocess(*terrain, options);
    const GroundHeights ground(*terrain);
    for (const int width : {1, BlockLayout::kSegment}) {
        const BlockTree tree(*terrain, ground, width, ErrorKind::average);
        fmt::print("dss, strips of {}, 1280 x 960, nothing culled\n",
                   width == 1 ? "one cell" : "one segment of the blocks beside them");
        print_rising_steps(tree);
        construct(tree, info, options);
        shapes(tree, ground, info, options);
        own_error(tree, ground, info, options);
    }
}

}  // namespace lodbench::benchmarks
