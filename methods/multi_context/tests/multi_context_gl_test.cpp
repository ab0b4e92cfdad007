// The method as a whole: what it selects, from which errors, and what it costs.

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "base/hash.h"
#include "multi_context_reference.h"
#include "run/frame_measurer.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using multi_context::Layout;
using Settings = std::vector<std::pair<std::string, std::string>>;
using Blocks = std::set<std::array<int, 3>>;

Camera lowered(const TerrainInfo& info, double share, double heading, double pitch) {
    const glm::dvec2 size = info.extent_max() - info.extent_min();
    Camera camera = camera_at({info.origin + size * glm::dvec2(share, 0.4), info.max_height + 300},
                              heading, pitch);
    camera.viewport = {640, 480};
    return camera;
}

/// {lod, row, column} of the blocks drawn: of each mesh's first triangle the vertices north-west
/// and south-west are a step of its LOD apart.
Blocks blocks_of(const measure::CapturedSurface& surface, const TerrainInfo& info, int k) {
    Blocks blocks;
    const std::size_t step = 6 * std::size_t(k - 1) * std::size_t(k - 1);
    EXPECT_EQ(surface.vertices.size() % step, 0U);
    for (std::size_t first = 0; first < surface.vertices.size(); first += step) {
        const glm::dvec2 nw = glm::dvec2(surface.world(first)) - info.origin;
        const glm::dvec2 sw = glm::dvec2(surface.world(first + 1)) - info.origin;
        const int column = int(std::lround(nw.x / info.spacing.x));
        const int row = info.rows - 1 - int(std::lround(nw.y / info.spacing.y));
        const int scale = int(std::lround((nw.y - sw.y) / info.spacing.y));
        const int cells = scale * (k - 1);
        EXPECT_EQ(row % cells, 0);
        EXPECT_TRUE(
            blocks.insert({std::countr_zero(unsigned(scale)), row / cells, column / cells}).second);
    }
    return blocks;
}

/// By errors for the camera `errors_for`, seen from `camera`; fails where a decision is within
/// rounding.
Blocks expected_blocks(const Terrain& terrain, int k, double delta, const Camera& errors_for,
                       const Camera& camera) {
    const Layout layout(terrain.info().rows, terrain.info().columns, k);
    const ReferenceErrors reference(terrain, layout, errors_for);
    return search_from_below(terrain, layout, camera, [&](int lod, int row, int column) {
        const Bounds bounds = reference.block(lod, row, column);
        EXPECT_EQ(bounds.low <= delta, bounds.high <= delta) << "too close to call";
        return bounds.high <= delta;
    });
}

Settings with(double delta, const Settings& more = {}) {
    Settings settings = {{"delta", std::to_string(delta)}, {"k", "17"}};
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

std::shared_ptr<const terrain::HeightField> large_hills() {
    return hills(513, 513);
}

TEST(MultiContext, draws_what_the_errors_in_double_demand_in_every_variant) {
    const auto terrain = hills(257, 230);
    const TerrainInfo& info = terrain->info();
    const std::vector<Settings> variants = {
        {},
        {{"readback", "blocks"}},
        {{"readback", "tree"}},
        {{"spread", "7"}},
        {{"readback", "blocks"}, {"spread", "64"}},
        {{"batch", "true"}},
        {{"async", "false"}},
        {{"readback", "blocks"}, {"batch", "true"}, {"async", "false"}}};
    for (const Settings& variant : variants) {
        Flight flight(terrain, "multi_context", "multi-context", with(7.3, variant));
        std::set<int> lods;
        for (int i = 0; i < 8; ++i) {
            const Camera camera = lowered(info, 0.1 * i, 40.0 * i, -5.0 * i);
            flight.select(camera);
            flight.stage().settle();
            EXPECT_EQ(flight.counter("errors_passes_so_far"), i + 1);
            const auto surface = flight.stage().capture();
            const Blocks found = blocks_of(surface, info, 17);
            EXPECT_EQ(found, expected_blocks(*terrain, 17, 7.3, camera, camera)) << "camera " << i;
            EXPECT_EQ(flight.counter("blocks_drawn"), double(found.size()));
            EXPECT_EQ(flight.stage().count_primitives(), found.size() * 2 * 16 * 16);
            for (const auto& block : found) lods.insert(block[0]);
        }
        EXPECT_GT(lods.size(), 2U);
    }
}

TEST(MultiContext, selects_as_with_floats_where_errors_are_bytes) {
    const auto terrain = large_hills();
    const Camera camera = lowered(terrain->info(), 0.3, 30, -20);
    const auto selected = [&](const char* readback, const char* errors) {
        Flight flight(terrain, "multi_context", "multi-context",
                      with(3.1, {{"readback", readback}, {"errors", errors}}));
        flight.select(camera);
        flight.stage().settle();
        return blocks_of(flight.stage().capture(), terrain->info(), 17);
    };
    const Blocks blocks = selected("whole", "float");
    EXPECT_GT(blocks.size(), 20U);
    EXPECT_EQ(selected("whole", "byte"), blocks);
    EXPECT_EQ(selected("blocks", "byte"), blocks);
    EXPECT_EQ(selected("tree", "byte"), blocks);
}

TEST(MultiContext, needs_37644_bytes_for_geometry_whatever_the_terrain) {
    for (const int size : {65, 257, 513}) {
        const auto terrain = hills(size, size);
        Flight flight(terrain, "multi_context", "multi-context",
                      {{"k", "33"}, {"readback", "blocks"}});
        flight.select(lowered(terrain->info(), 0.5, 10, -20));
        flight.stage().settle();
        EXPECT_EQ(flight.counter("geometry_bytes"), 37644);
        // Nothing beside it is geometry: heights, errors, the blocks' maxima twice, a camera.
        const Layout layout(size, size, 33);
        const std::size_t texels = std::size_t(size) * std::size_t(size);
        EXPECT_EQ(flight.stage().method_gpu_bytes(),
                  37644 + 4 * texels + 4 * texels + 8 * layout.count() + 256);
    }
}

TEST(MultiContext, batch_is_one_draw_call_with_the_same_triangles_and_none_is_one_a_block) {
    const auto terrain = large_hills();
    const Camera camera = lowered(terrain->info(), 0.3, 30, -20);
    std::vector<measure::CapturedSurface> surfaces;
    for (const char* batch : {"false", "true"}) {
        Flight flight(terrain, "multi_context", "multi-context", with(3, {{"batch", batch}}));
        flight.select(camera);
        flight.stage().settle();
        const std::uint64_t before = flight.stage().device().draw_calls();
        flight.stage().draw_picture();
        const auto calls = double(flight.stage().device().draw_calls() - before);
        EXPECT_EQ(calls, *batch == 't' ? 1 : flight.counter("blocks_drawn"));
        surfaces.push_back(flight.stage().capture());
    }
    EXPECT_GT(surfaces[0].vertices.size(), 0U);
    EXPECT_EQ(surfaces[0].vertices, surfaces[1].vertices);
}

// While paused no errors can arrive, so that how stale they are is known.
TEST(MultiContext, draws_with_the_errors_of_an_earlier_camera_until_newer_ones_are_there) {
    const auto terrain = hills(257, 257);
    const TerrainInfo& info = terrain->info();
    Flight flight(terrain, "multi_context", "multi-context", with(7.3));
    const Camera first = lowered(info, 0.2, 30, -20);
    flight.select(first);
    EXPECT_EQ(flight.counter("staleness_frames"), 0) << "waits where there is nothing yet";
    flight.stage().pause_background();
    Camera camera = first;
    for (int i = 1; i <= 4; ++i) {
        camera = lowered(info, 0.2 + 0.1 * i, 30 + 10 * i, -15);
        flight.select(camera);
        EXPECT_EQ(flight.counter("staleness_frames"), i);
        EXPECT_EQ(blocks_of(flight.stage().capture(), info, 17),
                  expected_blocks(*terrain, 17, 7.3, first, camera))
            << "this camera's view, the first one's errors";
    }
    flight.stage().resume_background();
    flight.stage().settle();
    EXPECT_EQ(flight.counter("staleness_frames"), 0);
    EXPECT_EQ(blocks_of(flight.stage().capture(), info, 17),
              expected_blocks(*terrain, 17, 7.3, camera, camera));
}

TEST(MultiContext, counts_how_stale_the_frames_of_the_flight_were_and_no_warm_up) {
    const auto terrain = hills(257, 257);
    Flight flight(terrain, "multi_context", "multi-context", with(7.3));
    const auto select = [&](int frame) {
        flight.stage().select(lowered(terrain->info(), 0.2 + 0.1 * frame, 30 + 10 * frame, -15),
                              {frame, frame / 20.0});
    };
    select(0);
    flight.stage().pause_background();
    for (int warmup = 1; warmup < 4; ++warmup) select(0);
    EXPECT_EQ(flight.counter("staleness_frames"), 0) << "of the camera that they are for";
    EXPECT_EQ(flight.counter("staleness_frames_unsettled_max_so_far"), 0);
    for (int frame = 1; frame < 5; ++frame) select(frame);  // 1, 2, 3, 4 cameras behind
    EXPECT_EQ(flight.counter("staleness_frames"), 4);
    select(0);  // what follows warms up for the lockstep replay
    select(0);
    EXPECT_EQ(flight.counter("staleness_frames"), 5);
    flight.stage().resume_background();
    for (int frame = 0; frame < 4; ++frame) {
        select(frame);
        flight.stage().settle();
        EXPECT_EQ(flight.counter("staleness_frames"), 0);
        EXPECT_EQ(flight.counter("staleness_frames_unsettled_mean_so_far"), 2);  // 0 + 1 + ... + 4
        EXPECT_EQ(flight.counter("staleness_frames_unsettled_max_so_far"), 4);
    }
}

/// What two lockstep replays are compared by.
std::string depth_hash(Flight& flight) {
    flight.stage().draw_picture();
    return flight.stage().depth_hash();
}

TEST(MultiContext,
     standing_still_makes_one_pass_and_the_next_movement_draws_as_if_there_were_none) {
    const auto terrain = hills(257, 257);
    const std::vector<int> path = {0, 0, 0, 0, 1, 2, 2, 2, 1, 1, 3};  // cameras: four movements
    const auto camera = [&](int i) {
        return lowered(terrain->info(), 0.2 + 0.1 * i, 30 + 10 * i, -15);
    };
    std::vector<std::string> expected;  // of flights that see one camera once
    for (int i = 0; i < 4; ++i) {
        Flight fresh(terrain, "multi_context", "multi-context", with(7.3));
        fresh.select(camera(i));
        fresh.stage().settle();
        expected.push_back(depth_hash(fresh));
    }
    EXPECT_EQ(std::set(expected.begin(), expected.end()).size(), 4U);
    for (const char* readback : {"whole", "blocks", "tree"}) {
        Flight flight(terrain, "multi_context", "multi-context",
                      with(7.3, {{"readback", readback}}));
        for (const int i : path) {
            flight.select(camera(i));
            flight.stage().settle();
            EXPECT_EQ(depth_hash(flight), expected[std::size_t(i)]) << "camera " << i;
        }
        EXPECT_EQ(flight.counter("errors_passes_so_far"), 5);
    }
}

TEST(MultiContext, asks_for_new_errors_where_anything_of_the_camera_changes) {
    const auto terrain = hills(129, 129);
    Flight flight(terrain, "multi_context", "multi-context", with(7.3));
    Camera camera = lowered(terrain->info(), 0.4, 30, -20);
    int passes = 0;
    const auto expect_a_pass = [&](const char* what) {
        for (int i = 0; i < 3; ++i) {
            flight.select(camera);
            flight.stage().settle();
        }
        EXPECT_EQ(flight.counter("errors_passes_so_far"), ++passes) << what;
    };
    expect_a_pass("the first");
    camera.position.z += 1e-9 * camera.position.z;
    expect_a_pass("position");
    camera.orientation = camera.orientation * glm::angleAxis(1e-6, glm::dvec3(0, 0, 1));
    expect_a_pass("orientation");
    camera.vertical_fov *= 1.001;
    expect_a_pass("lens");
    camera.near_plane *= 2;
    expect_a_pass("near plane");
    camera.viewport.height += 1;
    expect_a_pass("viewport");
}

// Three parts wait for a frame each: the errors of a new camera take at least as many to arrive.
TEST(MultiContext, a_read_back_that_is_spread_over_four_frames_arrives_after_three_more) {
    const auto terrain = hills(129, 129);
    for (const char* readback : {"whole", "blocks"}) {
        Flight flight(terrain, "multi_context", "multi-context",
                      with(7.3, {{"spread", "4"}, {"readback", readback}}));
        flight.select(lowered(terrain->info(), 0.2, 30, -20));
        EXPECT_EQ(flight.counter("staleness_frames"), 0) << "waits where there is nothing yet";
        const Camera next = lowered(terrain->info(), 0.6, 60, -10);
        flight.select(next);
        int frames = 0;
        while (flight.counter("staleness_frames") > 0) {
            ASSERT_LT(frames, 1000);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            flight.select(next);
            ++frames;
        }
        EXPECT_GE(frames, 3) << readback;
        EXPECT_EQ(flight.counter("errors_passes_so_far"), 2);
    }
}

TEST(MultiContext, a_tree_is_not_spread) {
    try {
        Flight flight(hills(65, 65), "multi_context", "multi-context",
                      {{"readback", "tree"}, {"spread", "2"}});
        FAIL() << "made";
    } catch (const std::exception& failure) {
        EXPECT_NE(std::string(failure.what()).find("leave spread at 1"), std::string::npos)
            << failure.what();
    }
}

TEST(MultiContext, is_never_behind_where_it_is_not_asynchronous) {
    const auto terrain = large_hills();
    Flight flight(terrain, "multi_context", "multi-context", with(7.3, {{"async", "false"}}));
    for (int i = 0; i < 5; ++i) {
        flight.stage().select(lowered(terrain->info(), 0.1 * i, 30, -20), {i, i / 20.0});
        EXPECT_EQ(flight.counter("staleness_frames"), 0);
        EXPECT_EQ(flight.counter("staleness_frames_unsettled_max_so_far"), 0);
    }
}

TEST(MultiContext, a_selection_stays_as_it_is_when_newer_errors_arrive) {
    const auto terrain = large_hills();
    Flight flight(terrain, "multi_context", "multi-context", with(3));
    flight.select(lowered(terrain->info(), 0.1, 30, -20));
    flight.select(lowered(terrain->info(), 0.6, 300, -10));
    const auto before = flight.stage().capture();
    std::this_thread::sleep_for(std::chrono::milliseconds(150));  // by now they are there
    EXPECT_EQ(flight.stage().capture().vertices, before.vertices);
}

TEST(MultiContext, lockstep_repeats_to_the_bit) {
    const auto terrain = large_hills();
    std::vector<std::vector<glm::vec3>> first;
    for (int replay = 0; replay < 3; ++replay) {
        Flight flight(terrain, "multi_context", "multi-context",
                      with(4, {{"readback", replay == 2 ? "blocks" : "whole"}}));
        for (int i = 0; i < 10; ++i) {
            const Camera camera = lowered(terrain->info(), 0.08 * i, 20 * i, -3 * i);
            flight.select(camera);
            if (replay == 1) flight.select(camera);  // whatever came before
            flight.stage().settle();
            auto surface = flight.stage().capture();
            if (replay == 0) {
                first.push_back(surface.vertices);
            } else {
                ASSERT_EQ(surface.vertices, first[std::size_t(i)]) << "frame " << i;
            }
        }
    }
}

TEST(MultiContext,
     skirts_reach_down_to_the_blocks_lowest_sample_but_not_along_the_terrains_border) {
    const auto terrain = hills(129, 129);
    const TerrainInfo& info = terrain->info();
    const Camera camera = lowered(info, 0.5, 0, -90);
    {
        Flight flight(terrain, "multi_context", "multi-context", with(1000, {{"cracks", "skirt"}}));
        flight.select(camera);
        flight.stage().settle();
        ASSERT_EQ(flight.counter("blocks_drawn"), 1) << "a single block: all its edges are borders";
        EXPECT_EQ(flight.stage().count_primitives(), 2U * 16 * 16 + 8 * 16);
        EXPECT_EQ(measure::nondegenerate_count(flight.stage().capture()), 2U * 16 * 16);
    }
    Flight flight(terrain, "multi_context", "multi-context", with(0.01, {{"cracks", "skirt"}}));
    flight.select(camera);
    flight.stage().settle();
    const auto surface = flight.stage().capture();
    const std::size_t per_block = 3 * (2U * 16 * 16 + 8 * 16);
    ASSERT_GT(surface.vertices.size(), per_block);
    ASSERT_EQ(surface.vertices.size() % per_block, 0U);
    std::size_t hanging = 0;
    for (std::size_t first = 0; first < surface.vertices.size(); first += per_block) {
        float low = 1e9F;
        for (std::size_t i = 0; i < 3 * 2 * 16 * 16; ++i) {
            low = std::min(low, surface.vertices[first + i].z);
        }
        for (std::size_t i = 3 * 2 * 16 * 16; i < per_block; ++i) {
            // LOD 0: the block's lowest sample is one of its vertices.
            ASSERT_GE(surface.vertices[first + i].z, low);
            hanging += surface.vertices[first + i].z == low;
        }
    }
    EXPECT_GT(hanging, surface.vertices.size() / per_block * 16);
}

TEST(MultiContext, skirts_hide_the_edge_of_a_cell_that_is_longer_than_a_block) {
    // Rough ground from column 512 on; west of it a ramp that a block of LOD 5 may stand for, whose
    // cell of 32 samples runs from 216 m down to 0 past two blocks of 16, below the northern one's
    // lowest sample.
    TerrainInfo info;
    info.name = "edge";
    info.rows = info.columns = 1025;
    info.spacing = {30, 30};
    std::vector<float> heights;
    base::SplitMix64 random(3);
    for (int row = 0; row < info.rows; ++row) {
        const double base = row <= 16 ? 216 : std::max(0.0, 13.5 * (32 - row));
        for (int column = 0; column < info.columns; ++column) {
            const double west = std::clamp((column - 480) / 32.0, 0.0, 1.0);
            const bool rough = column > 512 && row < 16;
            heights.push_back(float(base * west + (rough ? double(random.below(300)) : 0.0)));
        }
    }
    const auto terrain = std::make_shared<terrain::HeightField>(info, std::move(heights));
    Camera camera = camera_at({12360, 30360, 300}, 90, 0);
    camera.viewport = {640, 480};
    camera.near_plane = 10;
    std::uint64_t cracks[2] = {};
    for (const int skirts : {0, 1}) {
        Flight flight(terrain, "multi_context", "multi-context",
                      with(20, {{"cracks", skirts == 1 ? "skirt" : "none"}}));
        flight.stage().resize(camera.viewport);
        flight.stage().select(camera, {});
        flight.stage().settle();
        run::FrameMeasurer measurer(flight.stage(), std::nullopt, terrain);
        results::FrameRecord record;
        record.triangles = flight.stage().count_primitives();
        measurer.take(0, record, nullptr);
        measurer.measure(record);
        cracks[skirts] = record.crack_pixels.value();
    }
    EXPECT_GT(cracks[0], 100U);
    EXPECT_EQ(cracks[1], 0U);
}

TEST(MultiContext, is_skipped_where_the_driver_gives_no_second_context) {
    run::VitalSigns signs;
    run::Stage stage({hills(65, 65),
                      std::string(LODBENCH_PLUGINS) + "/multi_context.so",
                      "multi-context",
                      {},
                      ""},
                     signs);
    stage.device().set_context_factory({});
    stage.prepare();
    try {
        stage.upload();
        FAIL() << "uploaded";
    } catch (const run::MethodSkipped& skipped) {
        EXPECT_NE(std::string(skipped.what()).find("a further context was asked for"),
                  std::string::npos)
            << skipped.what();
    }
    stage.release();
}

/// A context that cannot be made current.
class Refusing final : public gl::SharedContext {
public:
    void make_current() override { throw UnsupportedError("cannot be made current"); }
    void release_current() noexcept override {}
};

TEST(MultiContext, ends_cleanly_where_its_thread_cannot_start) {
    run::VitalSigns signs;
    run::Stage stage({hills(65, 65),
                      std::string(LODBENCH_PLUGINS) + "/multi_context.so",
                      "multi-context",
                      {},
                      ""},
                     signs);
    const gl::ObjectCounts before = stage.device().objects();
    stage.device().set_context_factory([] { return std::make_unique<Refusing>(); });
    stage.prepare();
    EXPECT_THROW(stage.upload(), run::MethodSkipped);
    stage.release();
    EXPECT_EQ(stage.device().objects(), before);
}

TEST(MultiContext, refuses_a_terrain_that_no_texture_holds) {
    run::VitalSigns signs;
    gl::DeviceInfo device;
    {
        const run::Stage stage({hills(3, 3),
                                std::string(LODBENCH_PLUGINS) + "/multi_context.so",
                                "multi-context",
                                {},
                                ""},
                               signs);
        device = const_cast<run::Stage&>(stage).device().info();
    }
    const int columns = device.max_texture_size + 1;
    run::Stage stage({flat(2, columns, 0),
                      std::string(LODBENCH_PLUGINS) + "/multi_context.so",
                      "multi-context",
                      {},
                      ""},
                     signs);
    try {
        stage.prepare();
        FAIL() << "prepared";
    } catch (const run::MethodFailure& failure) {
        const std::string text = failure.what();
        EXPECT_NE(text.find("use a smaller terrain"), std::string::npos) << text;
        EXPECT_NE(text.find(std::to_string(columns) + " x 2"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace lodbench::test
