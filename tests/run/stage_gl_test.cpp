// Stage: whatever a method does wrong is told with the call and the plugin's name, and its counts
// are the GPU's.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

using run::Stage;
using run::VitalSigns;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

run::StageSetup broken(const std::string& plugin, const std::string& method) {
    return {flat(5, 5, 1),
            LODBENCH_BUILD_DIR "/broken-plugins/" + plugin + "/" + plugin + ".so",
            method,
            {},
            ""};
}

const Camera kAbove = camera_at({20, 20, 100}, 0, -60);

/// What `body` throws as MethodFailure; "" when it does not.
template <typename Body>
std::string failure_of(const Body& body) {
    try {
        body();
    } catch (const run::MethodFailure& failure) {
        return failure.what();
    }
    return {};
}

void make_ready(Stage& stage) {
    stage.prepare();
    stage.upload();
    stage.resize(kAbove.viewport);
}

TEST(Stage, names_call_and_plugin_of_what_is_thrown) {
    VitalSigns signs;
    EXPECT_EQ(failure_of([&] { Stage(broken("throws_in_create", "throws-in-create"), signs); }),
              "create of plugin throws_in_create.so threw: the moon is in the wrong house");
    Stage stage(broken("throws_in_select", "throws-in-select"), signs);
    make_ready(stage);
    EXPECT_EQ(failure_of([&] { stage.select(kAbove, {}); }),
              "select of plugin throws_in_select.so threw: no tile left");
    EXPECT_EQ(failure_of([&] { stage.release(); }), "") << "the rest of its life is as usual";
}

TEST(Stage, gl_errors_are_told_once_and_not_blamed_on_the_next_call) {
    VitalSigns signs;
    Stage stage(broken("raises_gl_error", "raises-gl-error"), signs);
    make_ready(stage);
    stage.select(kAbove, {});
    EXPECT_THAT(
        failure_of([&] { stage.draw_picture(); }),
        AllOf(StartsWith("draw of plugin raises_gl_error.so raised 1 GL error, the first: "),
              HasSubstr("GL_INVALID_ENUM")));
    EXPECT_EQ(failure_of([&] { stage.select(kAbove, {}); }), "");
    EXPECT_THAT(failure_of([&] { static_cast<void>(stage.count_primitives()); }),
                StartsWith("draw of plugin raises_gl_error.so raised 1 GL error"));
    EXPECT_THAT(failure_of([&] { static_cast<void>(stage.capture()); }),
                StartsWith("draw of plugin raises_gl_error.so raised 1 GL error"));
    EXPECT_FALSE(stage.device().capturing());
    EXPECT_FALSE(glIsEnabled(GL_RASTERIZER_DISCARD));
}

TEST(Stage, state_left_changed_is_told_and_put_back_while_checking) {
    VitalSigns signs;
    Stage stage(broken("leaves_state", "leaves-state"), signs);
    make_ready(stage);
    stage.select(kAbove, {});
    EXPECT_EQ(failure_of([&] { stage.draw_picture(); }), "") << "the timing replay does not look";
    stage.check_state(true);
    EXPECT_THAT(failure_of([&] { stage.draw_picture(); }),
                AllOf(StartsWith("draw of plugin leaves_state.so left GL state changed: "),
                      HasSubstr("GL_DEPTH_TEST")));
    EXPECT_TRUE(glIsEnabled(GL_DEPTH_TEST));
}

TEST(Stage, method_that_the_plugin_does_not_hold_is_the_users_mistake) {
    VitalSigns signs;
    EXPECT_THROW(Stage(broken("healthy", "nosuch"), signs), InputError);
}

TEST(Stage, signs_of_life_name_the_call_in_which_the_plugin_is) {
    VitalSigns signs;
    Stage stage(broken("throws_in_select", "throws-in-select"), signs);
    make_ready(stage);
    EXPECT_EQ(signs.call.load(), run::Call::none);
    const std::uint64_t beats = signs.beats.load();
    EXPECT_NE(failure_of([&] { stage.select(kAbove, {}); }), "");
    EXPECT_EQ(signs.call.load(), run::Call::select);
    EXPECT_GT(signs.beats.load(), beats);
}

}  // namespace
}  // namespace lodbench::test
