// hybrid-patches against static-patches: layout of Loeffler 2010, table 2, with the paper's claims
// L4 to L6, and what the spheres of validity cost. The paper does not say how it flew: here a tenth
// of a sample a frame, level, ten samples above the highest point.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "benchmarks.h"
#include "hybrid_patches/hybrid_frame.h"
#include "measure/timer_verdict.h"
#include "run/locations.h"
#include "run/stage.h"
#include "run/timing.h"

namespace lodbench::benchmarks {
namespace {

using common::Metric;
using hybrid_patches::HybridFrame;
using hybrid_patches::PatchCache;
using hybrid_patches::PatchHierarchy;

constexpr double kTolerances[] = {0.5, 1.0, 2.0};
constexpr int kSizes[] = {1025, 2049, 4097};
constexpr int kSegments = 64;
constexpr int kFewestFrames = 60;  ///< of the CPU's part

Camera camera_of(const TerrainInfo& info, int frame) {
    Camera camera;
    camera.viewport = {1280, 800};
    camera.vertical_fov = 0.8;
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    camera.position = {info.origin.x + 0.2 * size.x + 0.1 * frame * info.spacing.x,
                       info.origin.y + 0.5 * size.y, info.max_height + 10 * info.spacing.x};
    camera.orientation = Camera::look({1, 0.1, -0.2});
    return camera;
}

Camera jump_of(const TerrainInfo& info, std::mt19937& random) {
    Camera camera = camera_of(info, 0);
    const auto share = [&] { return std::uniform_real_distribution(0.1, 0.9)(random); };
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    camera.position.x = info.origin.x + share() * size.x;
    camera.position.y = info.origin.y + share() * size.y;
    return camera;
}

/// Seconds by frame.
struct CpuTimes {
    std::vector<double> select;  ///< with the tests of the spheres, up to where refinement begins
    std::vector<double> test;    ///< of the spheres alone, part of `select`
    std::vector<double> refine;
    std::size_t selected = 0, refined = 0;  ///< patches, in all frames
    std::size_t vertices = 0;               ///< tested by refinements
};

/// Of a frame that no other program has interrupted, it is hoped.
double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The CPU's part without a GPU: selection, sphere tests, refinement.
template <typename CameraOf>
CpuTimes fly_on_cpu(const common::LebRefiner& refiner, const PatchHierarchy& hierarchy, int frames,
                    const CameraOf& next_camera) {
    const common::RefinerOptions& options = refiner.options();
    PatchCache cache(hierarchy.size(), std::size_t(16) << 20, options.metric);
    HybridFrame frame(refiner.grid(), hierarchy, cache, options.tau, options.metric, true);
    CpuTimes times;
    // What can be repeated is measured warm: the shortest of a few.
    const auto shortest = [](const auto& work) {
        double least = 1e300;
        for (int k = 0; k < 7; ++k) least = std::min(least, seconds_of(work));
        return least;
    };
    for (int i = 0; i <= frames; ++i) {
        const Camera camera = next_camera(i);
        const double aim = seconds_of([&] { frame.aim(camera); });
        const double select = shortest([&] { frame.select(); });
        // Too short for the clock by itself.
        constexpr int kTimes = 40;
        const double test = shortest([&] {
                                for (int k = 0; k < kTimes; ++k) frame.test_spheres();
                            }) /
                            kTimes;
        const double sort_out = seconds_of([&] { frame.sort_out(); });
        const double refine = seconds_of([&] { frame.refine_all(); });
        std::size_t vertices = 0;
        frame.place_strips([&](const hybrid_patches::PlacedStrip& placed) {
            if (placed.refinement != nullptr) vertices += placed.refinement->tested;
        });
        if (i == 0) continue;  // all is new
        times.select.push_back(aim + select + test + sort_out);
        times.test.push_back(test);
        times.refine.push_back(refine);
        times.selected += frame.selected().size();
        times.refined += frame.refined();
        times.vertices += vertices;
    }
    return times;
}

struct Flown {
    double ms = 0, select_ms = 0, submit_ms = 0;
    double cpu_ms = 0;  ///< of all threads: what other programs take of the machine is not in it
    double triangles = 0, uploaded = 0, reused = 0, cache_bytes = 0;
    [[nodiscard]] double fps() const { return 1000 / ms; }
};

Flown fly(const std::shared_ptr<const terrain::HeightField>& terrain, const char* method,
          double tau, int frames) {
    run::VitalSigns signs;
    run::Stage stage({terrain,
                      run::default_plugin_folder() / "hybrid_patches.so",
                      method,
                      {{"tau", fmt::format("{}", tau)}},
                      ""},
                     signs);
    stage.prepare();
    stage.upload();
    stage.resize({1280, 800});
    const int warm_up = 2;
    Flown flown;
    std::unique_ptr<run::FrameTimer> timer;
    measure::TimerVerdict bracket;  // not trusted: every frame ends with glFinish
    for (int i = 0; i < warm_up + frames; ++i) {
        if (i == warm_up) timer = std::make_unique<run::FrameTimer>(stage.device(), bracket);
        const Camera camera = camera_of(terrain->info(), i);
        const std::uint64_t before = stage.method_uploaded_bytes();
        if (timer) timer->begin_frame();
        stage.select(camera, {i, i / 60.0});
        if (timer) timer->end_select();
        stage.draw(picture_view(camera));
        if (timer) timer->end_submit();
        if (!timer) continue;
        flown.uploaded += double(stage.method_uploaded_bytes() - before) / frames;
        double selected = 0, reused = 0;
        for (const auto& [name, value] : stage.counters()) {
            // static-patches, which has no swaps, and hybrid-patches.
            if (name == "triangles" || name == "triangles_without_swaps") {
                flown.triangles += value / frames;
            }
            if (name == "patches_selected") selected = value;
            if (name == "patches_reused") reused = value;
            if (name == "cache_bytes") flown.cache_bytes = std::max(flown.cache_bytes, value);
        }
        if (selected > 0) flown.reused += reused / selected / frames;
    }
    timer->finish();
    for (const run::FrameTimes& times : timer->frames()) {
        flown.ms += times.wall_ms / frames;
        flown.select_ms += times.select_ms / frames;
        flown.submit_ms += times.submit_ms / frames;
        flown.cpu_ms += times.cpu_ms / frames;
    }
    stage.release();
    return flown;
}

void print_cpu(const terrain::HeightField& whole, Metric metric, int most_samples, int frames) {
    fmt::print(
        "  CPU, {}\n         size   tau  patches  reused %  after jumps reused %  select us  "
        "sphere "
        "tests % of select  vertices tested  refine ms\n",
        metric == Metric::planar ? "planar" : "Euclidean");
    bool grows = true, refined_most_first = true;
    double most_of_select = 0, most_after_jumps = 0;
    for (const int size : kSizes) {
        if (size > most_samples) break;
        const auto terrain = north_west_corner(whole, size);
        double before = 0, least = 100;
        for (const double tau : kTolerances) {
            const common::LebRefiner refiner(*terrain,
                                             {.tau = tau, .metric = metric, .culling = false});
            const PatchHierarchy hierarchy(refiner.grid(), kSegments, terrain->info().rows,
                                           terrain->info().columns);
            const CpuTimes smooth = fly_on_cpu(refiner, hierarchy, frames, [&](int frame) {
                return camera_of(terrain->info(), frame);
            });
            std::mt19937 random(1);
            const CpuTimes jumps = fly_on_cpu(
                refiner, hierarchy, frames, [&](int) { return jump_of(terrain->info(), random); });
            const auto reused = [](const CpuTimes& t) {
                return 100.0 * double(t.selected - t.refined) /
                       double(std::max(t.selected, std::size_t(1)));
            };
            const double select = median(smooth.select);
            const double of_select = 100 * median(smooth.test) / select;
            fmt::print(
                "        {:5} {:5} {:8.0f} {:9.1f} {:21.2f} {:10.1f} {:25.2f} {:16.0f} {:10.2f}\n",
                size, tau, double(smooth.selected) / frames, reused(smooth), reused(jumps),
                1e6 * select, of_select, double(smooth.vertices) / frames,
                1e3 * median(smooth.refine));
            grows = grows && reused(smooth) > before;
            before = reused(smooth);
            if (tau == kTolerances[0]) least = before;
            refined_most_first = refined_most_first && least <= before;
            most_after_jumps = std::max(most_after_jumps, reused(jumps));
            most_of_select = std::max(most_of_select, of_select);
            std::fflush(stdout);
        }
    }
    fmt::print(
        "  L6, reuse on a smooth flight grows with the tolerance: {}; reused after jumps: at "
        "most {:.2f} %; sphere tests: up to {:.2f} % of select\n",
        grows ? "holds" : "does not hold", most_after_jumps, most_of_select);
    fmt::print("  L10, most patches are refined anew at the least tolerance: {}\n",
               refined_most_first ? "holds" : "does not hold");
}

/// A size's cells of table 2, by tolerance.
struct Cells {
    int size = 0;
    std::vector<Flown> plain, hybrid;
};

void judge(const std::vector<Cells>& table) {
    bool fewer = true, faster = true, gain_grows = true;
    double most = 0;
    for (const Cells& cells : table) {
        double before = 0;
        for (std::size_t i = 0; i < cells.plain.size(); ++i) {
            const double saved = 100 * (1 - cells.hybrid[i].triangles / cells.plain[i].triangles);
            const double gain = cells.hybrid[i].fps() / cells.plain[i].fps();
            fewer = fewer && saved > 0;
            most = std::max(most, saved);
            faster = faster && gain >= 1;
            gain_grows = gain_grows && gain > before;
            before = gain;
        }
    }
    const auto verdict = [](bool holds) { return holds ? "holds" : "does not hold"; };
    fmt::print("  L4, fewer triangles in every cell: {}, by up to {:.0f} % (L14: claimed 84)\n",
               verdict(fewer), most);
    fmt::print("  L5, at least as fast in every cell: {}\n", verdict(faster));
    fmt::print("  L9, the gain in fps grows with the tolerance at every size: {}\n",
               verdict(gain_grows));
    for (std::size_t size = 1; size < table.size(); ++size) {
        fmt::print("  L15, triangles from {} to {}: static", table[size - 1].size,
                   table[size].size);
        for (const auto& method : {&Cells::plain, &Cells::hybrid}) {
            const std::vector<Flown>& small = table[size - 1].*method;
            const std::vector<Flown>& large = table[size].*method;
            if (method == &Cells::hybrid) fmt::print(", hybrid");
            for (std::size_t i = 0; i < small.size(); ++i) {
                fmt::print(" {:.2f}", large[i].triangles / small[i].triangles);
            }
        }
        fmt::print(" times\n");
    }
    for (const Cells& cells : table) {
        fmt::print(
            "  L16, triangles at tau {} over those at {}, {}: static {:.2f}, hybrid {:.2f}\n",
            kTolerances[0], kTolerances[std::size(kTolerances) - 1], cells.size,
            cells.plain.front().triangles / cells.plain.back().triangles,
            cells.hybrid.front().triangles / cells.hybrid.back().triangles);
    }
}

}  // namespace

void patches_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> whole = terrain::load_terrain(options.source());
    // In a few frames of the few patches of a large tolerance, single ones would decide about L6.
    const int frames = std::max(options.frames, kFewestFrames);
    fmt::print("patches, {}, 1280 x 800; CPU: {} frames, table 2: {}\n", whole->info().name, frames,
               options.frames);
    for (const Metric metric : {Metric::euclidean, Metric::planar}) {
        print_cpu(*whole, metric, options.size, frames);
    }
    fmt::print(
        "  table 2 size   tau |  static fps  triangles | hybrid fps  triangles  reused %  "
        "uploaded KiB  cache KiB | fewer triangles  fps ratio | CPU ms: static, hybrid\n");
    std::vector<Cells> table;
    for (const int size : kSizes) {
        if (size > options.size) break;
        const auto terrain = north_west_corner(*whole, size);
        table.push_back({size, {}, {}});
        for (const double tau : kTolerances) {
            const Flown plain = fly(terrain, "static-patches", tau, options.frames);
            const Flown hybrid = fly(terrain, "hybrid-patches", tau, options.frames);
            const double saved = 100 * (1 - hybrid.triangles / plain.triangles);
            table.back().plain.push_back(plain);
            table.back().hybrid.push_back(hybrid);
            fmt::print(
                "          {:5} {:5} | {:11.1f} {:10.0f} | {:10.1f} {:10.0f} {:9.1f} {:13.1f} "
                "{:10.0f} | {:14.1f}% {:10.2f} | {:6.1f} {:6.1f}  (hybrid: select {:.1f}, submit "
                "{:.1f} "
                "of {:.1f} ms)\n",
                size, tau, plain.fps(), plain.triangles, hybrid.fps(), hybrid.triangles,
                100 * hybrid.reused, hybrid.uploaded / 1024, hybrid.cache_bytes / 1024, saved,
                hybrid.fps() / plain.fps(), plain.cpu_ms, hybrid.cpu_ms, hybrid.select_ms,
                hybrid.submit_ms, hybrid.ms);
            std::fflush(stdout);
        }
    }
    judge(table);
}

}  // namespace lodbench::benchmarks
