#include "window/controls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "scenario/flight_path.h"
#include "support/run_lodbench.h"

namespace lodbench::window {
namespace {

double level(const glm::dvec2& place) {
    return 100 + 0.1 * place.x;
}

Camera over_plain() {
    Camera camera;
    camera.position = {1000, 2000, 500};
    camera.orientation = scenario::orientation_of(90, -10, 0);
    return camera;
}

TEST(FlyCamera, flies_where_it_looks_as_fast_as_the_wheel_says) {
    FlyCamera fly;
    fly.take_over(over_plain());
    fly.change_speed(1);
    EXPECT_DOUBLE_EQ(fly.speed(), 625);
    fly.step({.ahead = 1}, 0.5, level);
    const glm::dvec3 way = fly.camera().position - over_plain().position;
    EXPECT_NEAR(glm::length(way), 312.5, 2e-3);  // rounded to millimetres
    EXPECT_NEAR(glm::dot(glm::normalize(way), over_plain().forward()), 1, 1e-9);
    fly.step({.turn_right = 45, .turn_up = 200}, 0.5, level);
    EXPECT_EQ(fly.place().angles, glm::dvec3(135, 89, 0));
    fly.change_speed(-1000);
    EXPECT_EQ(fly.speed(), FlyCamera::kSlowest);
    fly.change_speed(1000);
    EXPECT_EQ(fly.speed(), FlyCamera::kFastest);
}

TEST(FlyCamera, keeps_its_height_above_the_ground_that_it_follows) {
    FlyCamera fly;
    fly.take_over(over_plain());
    fly.follow_ground(true, level);
    fly.step({.ahead = 1}, 1, level);
    EXPECT_NEAR(fly.camera().position.x, 1500, 1e-3);
    EXPECT_NEAR(fly.camera().position.z, level(glm::dvec2(fly.camera().position)) + 300, 1e-3);
    fly.step({.up = -1}, 100, level);
    EXPECT_NEAR(fly.camera().position.z, level(glm::dvec2(fly.camera().position)) + 1, 1e-3);
}

TEST(FlyCamera, what_is_recorded_is_the_camera_that_was_shown_to_the_bit) {
    FlyCamera fly;
    fly.take_over(over_plain());
    PathRecorder recorder;
    recorder.start();
    std::vector<Camera> shown;
    for (int i = 0; i < 200; ++i) {
        fly.step({.ahead = 1, .right = i % 3 - 1, .turn_right = 0.37 * i, .turn_up = 0.013},
                 1 / 60.0, level);
        recorder.add(fly.place());
        shown.push_back(fly.camera());
    }
    const auto places = scenario::parse_recorded(recorder.stop(), "path.csv");
    ASSERT_EQ(places.size(), shown.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec3& a = places[i].angles;
        EXPECT_EQ(places[i].position, shown[i].position) << i;
        EXPECT_EQ(scenario::orientation_of(a.x, a.y, a.z), shown[i].orientation) << i;
    }
    EXPECT_EQ(recorder.frames(), 200U);
    EXPECT_FALSE(recorder.recording());
}

TEST(Playback, plays_at_the_simulated_rate_steps_and_scrubs_within_the_path) {
    Playback playback(120, 60);
    EXPECT_FALSE(playback.advance(1));
    playback.play(true);
    EXPECT_TRUE(playback.advance(0.5));
    EXPECT_EQ(playback.frame(), 30);
    playback.step(-1);
    EXPECT_EQ(playback.frame(), 29);
    EXPECT_FALSE(playback.playing());
    playback.seek(500);
    EXPECT_EQ(playback.frame(), 119);
    playback.play(true);
    EXPECT_EQ(playback.frame(), 0);
    EXPECT_TRUE(playback.advance(100));
    EXPECT_EQ(playback.frame(), 119);
    EXPECT_FALSE(playback.playing());
    playback.seek(-3);
    EXPECT_EQ(playback.frame(), 0);
}

TEST(Layouts, every_position_shows_the_method_and_the_place_that_its_pane_does) {
    const auto at = [](Layout layout, double x, bool second = false) {
        const PicturePlace place = picture_place(layout, 0.25, second, {x, 0.5});
        return std::pair(place.method, place.at.x);
    };
    EXPECT_EQ(at(Layout::single, 0.5), std::pair(0, 0.5));
    EXPECT_EQ(at(Layout::side_by_side, 0.25), std::pair(0, 0.5));
    EXPECT_EQ(at(Layout::side_by_side, 0.75), std::pair(1, 0.5));
    EXPECT_EQ(at(Layout::split, 0.125), std::pair(0, 0.125));
    EXPECT_EQ(at(Layout::split, 0.625), std::pair(1, 0.625));
    EXPECT_EQ(at(Layout::blink, 0.5, false), std::pair(0, 0.5));
    EXPECT_EQ(at(Layout::blink, 0.5, true), std::pair(1, 0.5));
    EXPECT_EQ(picture_size(Layout::side_by_side, {800, 600}), (Viewport{400, 600}));
    EXPECT_EQ(picture_size(Layout::split, {800, 600}), (Viewport{800, 600}));
    EXPECT_EQ(picture_size(Layout::single, {0, 0}), (Viewport{1, 1}));
    EXPECT_EQ(difference({10, 200, 7}, {10, 100, 9}), (std::vector<std::uint8_t>{0, 255, 16}));
    std::set<Layout> all;
    for (Layout layout = Layout::single; all.insert(layout).second; layout = next(layout)) {
    }
    EXPECT_EQ(all.size(), 5U);
}

TEST(Keys, none_means_two_things_and_every_one_is_found) {
    std::set<std::pair<int, bool>> keys;
    std::set<Action> actions;
    for (const KeyBinding& binding : key_bindings()) {
        EXPECT_TRUE(keys.emplace(binding.key, binding.control).second) << binding.name;
        EXPECT_TRUE(actions.insert(binding.action).second) << binding.name;
        EXPECT_EQ(action_of(binding.key, binding.control), binding.action);
    }
    EXPECT_EQ(actions.size(), std::size_t(Action::quit) + 1);
    EXPECT_EQ(action_of('J', false), std::nullopt);
}

TEST(Keys, are_in_the_documents_as_help_has_them) {
    const std::string page = test::text_of(LODBENCH_SOURCE_DIR "/docs/window.md");
    for (const KeyBinding& binding : key_bindings()) {
        EXPECT_THAT(page, testing::HasSubstr(std::string("| `") + binding.name + "` | " +
                                             binding.does + " |\n"));
    }
}

TEST(FrameTimes, keep_the_last_and_give_nearest_rank_percentiles) {
    FrameTimes times;
    EXPECT_EQ(times.percentile(0.5), std::nullopt);
    for (int i = 1; i <= 1000; ++i) times.add(i);
    EXPECT_EQ(times.ms().size(), FrameTimes::kKept);
    EXPECT_EQ(times.ms().front(), 761);
    EXPECT_EQ(times.percentile(1), 1000);
    EXPECT_EQ(times.percentile(0.5), 880);
}

TEST(Frustum, lines_end_in_the_corners_of_the_picture_and_the_top_camera_sees_them) {
    Camera camera = over_plain();
    camera.viewport = {400, 300};
    const Camera top = top_camera(camera, 1000);
    EXPECT_NEAR(top.forward().z, -1, 1e-12);
    const auto lines = frustum_lines(camera, 1000);
    ASSERT_EQ(lines.size(), 8U);
    for (const auto& [from, to] : lines) {
        const auto corner = camera.project(to);
        ASSERT_TRUE(corner);
        EXPECT_NEAR(std::abs(corner->x - 200), 200, 1e-6);
        EXPECT_NEAR(std::abs(corner->y - 150), 150, 1e-6);
        for (const glm::dvec3& end : {from, to}) {
            const auto seen = top.project(end);
            ASSERT_TRUE(seen);
            EXPECT_TRUE(seen->x >= 0 && seen->x <= 400 && seen->y >= 0 && seen->y <= 300);
        }
    }
}

}  // namespace
}  // namespace lodbench::window
