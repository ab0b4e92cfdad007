// multi-context's parts: the errors pass level by level, what comes back from the GPU, the
// traversal that uses it, and one draw call a block against one for all. Yusuf 2014 names the
// download as its bottleneck and proposes bytes, and fetching no more than is needed.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "benchmarks.h"
#include "multi_context/block_tree.h"
#include "multi_context/errors_pass.h"
#include "platform/context.h"
#include "run/locations.h"
#include "run/stage.h"

namespace lodbench::benchmarks {
namespace {

using multi_context::BlockErrors;
using multi_context::ErrorsPass;
using multi_context::HeightRanges;
using multi_context::Layout;
using multi_context::ReadBack;
using multi_context::Selection;
using multi_context::Traversal;

constexpr int kSizes[] = {1025, 2049, 4097};

/// From the middle of the southern edge, an eighth of the terrain's side above it.
Camera camera_of(const TerrainInfo& info, int frame) {
    Camera camera;
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    camera.position = {info.origin.x + (0.5 + 0.001 * frame) * size.x, info.origin.y,
                       info.max_height + 0.125 * size.y};
    camera.orientation = Camera::look({0, 1, -0.3});
    camera.near_plane = 10;
    return camera;
}

/// Shortest of several, in ms: the machine's other work only adds.
template <typename Work>
double shortest_ms(int repetitions, const Work& work) {
    double best = 1e300;
    for (int i = 0; i < repetitions; ++i) best = std::min(best, 1e3 * seconds_of(work));
    return best;
}

struct Form {
    const char* name;
    ReadBack read_back;
    bool bytes;
};
constexpr Form kForms[] = {
    {"whole, float", ReadBack::whole, false},   {"whole, byte", ReadBack::whole, true},
    {"blocks, float", ReadBack::blocks, false}, {"blocks, byte", ReadBack::blocks, true},
    {"tree, float", ReadBack::tree, false},     {"tree, byte", ReadBack::tree, true}};

void errors_of(const Terrain& terrain, float delta, int repetitions) {
    const TerrainInfo& info = terrain.info();
    const platform::Context context;
    gl::Device device;
    gl::Texture heights(device, "heights", GL_TEXTURE_2D, GL_R32F, info.columns, info.rows);
    const Layout layout(info.rows, info.columns, 33);
    const HeightRanges ranges(terrain, layout, [&](const SampleRect& rect, auto strip) {
        heights.write(0, 0, rect.row, rect.columns, rect.rows, GL_RED, GL_FLOAT, strip.data());
    });
    glFinish();
    const Camera camera = camera_of(info, 0);
    double read_back_of_whole = 0, all_of_whole = 0;
    for (const Form& form : kForms) {
        ErrorsPass pass(
            device, heights, info,
            {.k = 33, .delta = delta, .bytes = form.bytes, .read_back = form.read_back});
        BlockErrors errors;
        pass.run(camera, errors);
        std::string levels;
        double sum = 0;
        pass.begin(camera);
        for (int level = 1; level <= layout.n(); ++level) {
            const double ms = shortest_ms(repetitions, [&] {
                pass.evaluate_level(level);
                glFinish();
            });
            if (level <= 4) levels += fmt::format("{:8.2f}", ms);
            sum += ms;
        }
        const double read_back = shortest_ms(repetitions, [&] { pass.read_back(errors); });
        const double all = shortest_ms(repetitions, [&] { pass.run(camera, errors); });
        Selection selection;
        const double traversal = shortest_ms(repetitions, [&] {
            Traversal(info, layout, ranges, errors, delta, camera).select(selection);
        });
        if (form.read_back == ReadBack::whole && !form.bytes) {
            read_back_of_whole = read_back;
            all_of_whole = all;
        }
        fmt::print(
            "  {:5}  {:14}{}{:8.2f} | {:9.0f} {:9.2f} {:9.2f} | {:9.2f} {:9.2f} | {:9.3f} {:6}\n",
            info.rows, form.name, levels, sum, double(errors.read_back_bytes) / 1024, read_back,
            read_back_of_whole / read_back, all, all_of_whole / all, traversal,
            selection.blocks.size());
        std::fflush(stdout);
    }
}

struct Drawn {
    double blocks = 0, submit_ms = 0, frame_ms = 0;
};

Drawn draw(const std::shared_ptr<const terrain::HeightField>& terrain, double delta, bool batch,
           int size, const Options& options) {
    run::VitalSigns signs;
    run::Stage stage({terrain,
                      run::default_plugin_folder() / "multi_context.so",
                      "multi-context",
                      {{"delta", fmt::format("{}", delta)},
                       {"batch", batch ? "true" : "false"},
                       {"readback", "blocks"}},
                      ""},
                     signs);
    stage.prepare();
    stage.upload();
    stage.resize({size, size * 3 / 4});
    Drawn drawn;
    for (int frame = 0; frame < options.frames; ++frame) {
        Camera camera = camera_of(terrain->info(), frame);
        camera.viewport = {size, size * 3 / 4};
        stage.select(camera, {frame, frame / 60.0});
        stage.settle();
        stage.pause_background();
        for (const auto& [name, value] : stage.counters()) {
            if (name == "blocks_drawn") drawn.blocks += value / options.frames;
        }
        double submit = 1e300, whole = 1e300;
        for (int i = 0; i <= options.repetitions; ++i) {
            glFinish();
            double submitted = 0;
            const double seconds = seconds_of([&] {
                submitted = seconds_of([&] { stage.draw(picture_view(camera)); });
                glFinish();
            });
            if (i == 0) continue;  // warms up
            submit = std::min(submit, submitted);
            whole = std::min(whole, seconds);
        }
        drawn.submit_ms += 1e3 * submit / options.frames;
        drawn.frame_ms += 1e3 * whole / options.frames;
        stage.resume_background();
    }
    stage.release();
    return drawn;
}

}  // namespace

void blocks_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> whole = terrain::load_terrain(options.source());
    fmt::print("blocks, {}: k = 33, delta = 1, shortest of {}\n", whole->info().name,
               options.repetitions);
    fmt::print(
        "  errors                ms: level 1       2       3       4     1..n | read-back KiB  ms  "
        "whole/this | all, ms whole/this | traversal ms  blocks\n");
    for (const int size : kSizes) {
        if (size > std::min({options.size, whole->info().rows, whole->info().columns})) break;
        errors_of(*north_west_corner(*whole, size), 1, options.repetitions);
    }
    fmt::print(
        "  draws   size  picture  delta  blocks | submit ms: a block  all  ratio | to the end: a "
        "block  all  ratio\n");
    for (const int size : kSizes) {
        if (size > std::min({options.size, whole->info().rows, whole->info().columns})) break;
        const auto terrain = north_west_corner(*whole, size);
        for (const int picture : {64, 640}) {
            for (const double delta : {0.5, 2.0, 8.0}) {
                const Drawn single = draw(terrain, delta, false, picture, options);
                const Drawn batch = draw(terrain, delta, true, picture, options);
                fmt::print(
                    "         {:5} {:8} {:6} {:7.0f} | {:18.2f} {:6.2f} {:6.2f} | {:18.2f} {:6.2f} "
                    "{:6.2f}\n",
                    size, picture, delta, single.blocks, single.submit_ms, batch.submit_ms,
                    single.submit_ms / batch.submit_ms, single.frame_ms, batch.frame_ms,
                    single.frame_ms / batch.frame_ms);
                std::fflush(stdout);
            }
        }
    }
}

}  // namespace lodbench::benchmarks
