// Methods in processes of their own, as the window asks them.

#include "window/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "results/frame.h"
#include "support/frames_csv.h"
#include "support/run_lodbench.h"
#include "window/messages.h"
#include "window/session_flight.h"

namespace lodbench::window {
namespace {

namespace fs = std::filesystem;
using test::camera_of_frame;
using test::request_of;
using testing::HasSubstr;
using Flight = test::SessionFlight;

TEST(Session, measured_frame_equals_that_of_a_run_in_every_figure) {
    Flight flight;
    for (const auto& [method, tau] : {std::pair("lindstrom", "4"), std::pair("clipmap", "")}) {
        const fs::path out = flight.folder() / method;
        const std::string set = std::string(method) + ".tau=" + tau;
        std::vector<std::string> arguments = {
            "run",   flight.file().string(), "-m",         method,
            "--out", out.string(),           "--override", "measure.every=1"};
        run::Settings settings;
        if (*tau != 0) {
            arguments.insert(arguments.end(), {"--set", set});
            settings.emplace_back("tau", tau);
        }
        const test::Finished done = test::run_lodbench(arguments, flight.folder());
        ASSERT_EQ(done.status, 0) << done.output;
        const fs::path csv = fs::directory_iterator(out / "frames")->path();
        const std::vector<test::FrameTexts> flown = test::read_frames_csv(csv);
        ASSERT_EQ(flown.size(), 4U);
        (void)flight.open(flight.own(method, settings));
        for (const int frame : {2, 0}) {
            Json::Value ask;
            ask["do"] = "measure";
            ask["frame"] = frame;
            ask["flown"] = true;
            flight.session().ask(ask);
            const Json::Value answer = flight.answer();
            ASSERT_FALSE(answer.isMember("refused") || answer.isMember("failed")) << answer;
            results::FrameRecord record;
            results::decode(answer["record"], record, {"answer", ""});
            const fs::path mine = flight.folder() / "measured.csv";
            std::ofstream(mine) << results::frames_csv({record});
            int compared = 0;
            const test::FrameTexts here = test::read_frames_csv(mine).at(0);
            for (const auto& [name, text] : here) {
                // Times are the timing replay's, popping is to a frame that was not measured here.
                if (name.ends_with("_ms") || name.starts_with("popping")) continue;
                EXPECT_EQ(text, flown[std::size_t(frame)].at(name))
                    << method << " frame " << frame << " " << name;
                compared += text.empty() ? 0 : 1;
            }
            EXPECT_GE(compared, 18);
            EXPECT_GT(record.triangles.value_or(0), 0U);
        }
    }
}

TEST(Session, heat_map_of_a_picture_has_the_harness_figures_of_that_frame) {
    Flight flight;
    (void)flight.open(flight.own("lindstrom", {{"tau", "8"}}));
    PictureRequest request = request_of(camera_of_frame(flight.file(), 1));
    const PictureReply shaded = flight.picture(request);
    EXPECT_FALSE(shaded.pixel_max_px);
    const auto plain = flight.pixels(shaded);
    request.style = Style::errors;
    const PictureReply judged = flight.picture(request);
    EXPECT_NE(flight.pixels(judged), plain);
    Json::Value ask;
    ask["do"] = "measure";
    ask["frame"] = 1;
    flight.session().ask(ask);
    results::FrameRecord record;
    results::decode(flight.answer()["record"], record, {"answer", ""});
    EXPECT_EQ(judged.triangles, record.triangles);
    EXPECT_EQ(judged.pixel_max_px, record.pixel_max_px);
    EXPECT_EQ(judged.pixel_p999_px, record.pixel_p999_px);
    EXPECT_EQ(judged.pixel_rms_px, record.pixel_rms_px);
    EXPECT_EQ(judged.crack_pixels, record.crack_pixels);
    EXPECT_GT(record.pixel_max_px.value_or(0), 0.5);
}

TEST(Session, frozen_selection_is_seen_from_elsewhere_and_drawn_the_same_on_return) {
    Flight flight;
    (void)flight.open(flight.own("lindstrom", {{"tau", "4"}}));
    PictureRequest request = request_of(camera_of_frame(flight.file(), 0));
    const PictureReply before = flight.picture(request);
    const auto first = flight.pixels(before);
    request.frozen = true;
    request.view = camera_of_frame(flight.file(), 3);
    const PictureReply frozen = flight.picture(request);
    EXPECT_EQ(frozen.triangles, before.triangles);
    EXPECT_NE(flight.pixels(frozen), first);
    request.frozen = false;
    request.selected = request.view;
    const PictureReply live = flight.picture(request);
    EXPECT_NE(live.triangles, before.triangles);
    request = request_of(camera_of_frame(flight.file(), 0));
    EXPECT_EQ(flight.pixels(flight.picture(request)), first);
    for (const Style style : {Style::levels, Style::cracks}) {
        request.style = style;
        EXPECT_NE(flight.pixels(flight.picture(request)), first) << name_of(style);
    }
    request.style = Style::shaded;
    request.wireframe = true;
    EXPECT_NE(flight.pixels(flight.picture(request)), first);
}

TEST(Session, probe_tells_sample_heights_error_and_level_below_a_pixel) {
    Flight flight;
    (void)flight.open(flight.own("full-grid"));
    (void)flight.picture(request_of(camera_of_frame(flight.file(), 0)));
    const auto probe = [&](double x, double y) {
        Json::Value ask;
        ask["do"] = "probe";
        ask["x"] = x;
        ask["y"] = y;
        flight.session().ask(ask);
        return probe_reply(flight.answer());
    };
    const ProbeReply ground = probe(80, 110);
    ASSERT_TRUE(ground.hit);
    // Every sample is drawn: nothing is wrong, and all triangles are of level 0.
    EXPECT_EQ(ground.level, 0);
    ASSERT_TRUE(ground.drawn && ground.error_px);
    EXPECT_LT(*ground.error_px, 0.01);
    EXPECT_NEAR(*ground.drawn, ground.true_high, 30);
    EXPECT_NEAR(ground.column, ground.x / 30, 0.6);
    EXPECT_NEAR(256 - ground.row, ground.y / 30, 0.6);
    EXPECT_FALSE(probe(80, 1000).hit);
}

TEST(Session, process_of_a_method_that_crashes_is_replaced_within_a_second_and_says_why) {
    Flight flight;
    (void)flight.open(flight.own("full-grid"));
    const PictureRequest request = request_of(camera_of_frame(flight.file(), 0));
    const auto picture = flight.pixels(flight.picture(request));
    double least_s = 100;  // of three: another process may have the processor
    for (int i = 0; i < 3; ++i) {
        const pid_t before = flight.session().process();
        (void)flight.open(
            flight.spec("segfaults", test::broken_plugin_folder("segfaults") + "/segfaults.so"));
        flight.session().ask(to_json(request));
        const auto start = std::chrono::steady_clock::now();
        // The next answer is that of the new process, which opens what was good.
        const Json::Value opened = flight.answer();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        EXPECT_EQ(opened["did"].asString(), "open");
        EXPECT_EQ(opened["method"].asString(), "full-grid");
        least_s = std::min(least_s, took.count());
        EXPECT_EQ(flight.session().fallen(),
                  "'segfaults' of segfaults.so fell: segmentation fault (signal 11), in draw");
        EXPECT_NE(flight.session().process(), before);
        EXPECT_EQ(flight.pixels(flight.picture(request)), picture);
    }
    std::printf("replaced after %.0f ms\n", least_s * 1e3);
    EXPECT_LT(least_s, 1.0);
}

TEST(Session, method_that_throws_or_is_ended_falls_alone_and_says_why) {
    Flight flight;
    (void)flight.open(flight.own("full-grid"));
    const PictureRequest request = request_of(camera_of_frame(flight.file(), 0));
    (void)flight.picture(request);
    (void)flight.open(
        flight.spec("throws-in-select",
                    test::broken_plugin_folder("throws_in_select") + "/throws_in_select.so"));
    flight.session().ask(to_json(request));
    EXPECT_THAT(flight.answer()["failed"].asString(), HasSubstr("threw"));
    EXPECT_EQ(flight.answer()["method"].asString(), "full-grid");
    EXPECT_THAT(flight.session().fallen(),
                testing::AllOf(HasSubstr("'throws-in-select'"), HasSubstr("select of plugin")));
    (void)flight.open(flight.spec("loops", test::broken_plugin_folder("loops") + "/loops.so"));
    flight.session().ask(to_json(request));
    flight.session().end();
    EXPECT_EQ(flight.answer()["method"].asString(), "full-grid");
    EXPECT_THAT(flight.session().fallen(), HasSubstr("was ended on request"));
}

TEST(Session, program_that_never_answers_is_not_started_again_and_again) {
    Session session("/bin/false", [] {});
    Flight flight;
    session.open(flight.own("full-grid"));
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    std::string fell;
    while (fell.empty() && std::chrono::steady_clock::now() < deadline) {
        EXPECT_THAT(session.take(), testing::IsEmpty());
        fell = session.fallen();
    }
    EXPECT_EQ(fell, "'full-grid' of full_grid.so fell: the process exited with status 1");
    EXPECT_EQ(session.process(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // for another to start and end
    EXPECT_THAT(session.take(), testing::IsEmpty());
    EXPECT_EQ(session.fallen(), "");
}

TEST(Session, switches_leave_nothing_of_a_method_behind) {
    Flight flight;
    const PictureRequest request = request_of(camera_of_frame(flight.file(), 0));
    for (const char* method :
         {"lindstrom", "clipmap", "full-grid", "hybrid-patches", "pgm", "lindstrom"}) {
        const Json::Value opened = flight.open(flight.own(method));
        ASSERT_FALSE(opened.isMember("refused") || opened.isMember("failed")) << opened;
        EXPECT_EQ(opened["leaks"].asString(), "") << "before " << method;
        EXPECT_GT(flight.picture(request).triangles, 0U);
    }
    EXPECT_EQ(flight.session().fallen(), "");
}

}  // namespace
}  // namespace lodbench::window
