// lodbench frames, and the options --camera and --flight that say where to fly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "picture/png.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

const char* const kCamera = "camera:20,20.125,300:12.5,-60,0:60:1";

Json::Value frames_json(const fs::path& out) {
    return results::parse_json(text_of(out / "frames.json"), "frames.json");
}

picture::Image picture_of(const fs::path& file) {
    const std::string bytes = text_of(file);
    const auto image =
        picture::read_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (!image) throw std::runtime_error(file.string() + " is no picture");
    return *image;
}

TEST(Frames, pictures_of_method_and_reference_are_numbered_with_the_rate_beside_them) {
    const ScratchFolder scratch;
    const fs::path scenario = tiny_scenario(scratch.path(), "");
    const fs::path out = scratch.path() / "film";
    const Finished done = run_lodbench({"frames", "full-grid", scenario.string(), "-o",
                                        out.string(), "--override", "flight.pitch=-60"},
                                       scratch.path());
    ASSERT_EQ(done.status, 0) << done.output;
    const Json::Value about = frames_json(out);
    EXPECT_EQ(about["rate_hz"].asDouble(), 60);
    EXPECT_EQ(about["frames"].asInt(), 2);
    EXPECT_EQ(about["cameras"].size(), 2U);
    EXPECT_EQ(about["method"].asString(), "full-grid");
    for (const char* frame : {"00000.png", "00001.png"}) {
        const picture::Image drawn = picture_of(out / "method" / frame);
        const picture::Image reference = picture_of(out / "reference" / frame);
        EXPECT_EQ(drawn.width, 32);
        EXPECT_EQ(drawn.height, 24);
        // Of a ramp, every sample is the truth.
        EXPECT_EQ(drawn.rgb, reference.rgb) << frame;
    }
    EXPECT_NE(picture_of(out / "method/00000.png").rgb, picture_of(out / "method/00001.png").rgb);
    const Finished again = run_lodbench(
        {"frames", "full-grid", scenario.string(), "-o", out.string()}, scratch.path());
    EXPECT_EQ(again.status, 2);
    EXPECT_THAT(again.output, HasSubstr("not empty"));
}

TEST(Frames, camera_and_recorded_flight_are_flown_to_the_bit) {
    const ScratchFolder scratch;
    const fs::path scenario = tiny_scenario(scratch.path(), "");
    const fs::path still = scratch.path() / "still";
    Finished done = run_lodbench({"frames", "full-grid", scenario.string(), "--camera", kCamera,
                                  "--frames", "1", "--no-reference", "-o", still.string()},
                                 scratch.path());
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_EQ(frames_json(still)["cameras"][0].asString(), kCamera);
    EXPECT_FALSE(fs::exists(still / "reference"));

    const fs::path csv = scratch.path() / "a \"path\".csv";
    std::ofstream(csv) << "frame,x,y,z,heading,pitch,roll\n0,20,20.125,300,12.5,-60,0\n"
                          "1,20.5,20.125,300,12.5,-60,0\n";
    const fs::path flown = scratch.path() / "flown";
    done = run_lodbench({"frames", "full-grid", scenario.string(), "--flight", csv.string(),
                         "--no-reference", "-o", flown.string()},
                        scratch.path());
    ASSERT_EQ(done.status, 0) << done.output;
    const Json::Value cameras = frames_json(flown)["cameras"];
    ASSERT_EQ(cameras.size(), 2U);
    EXPECT_EQ(cameras[0].asString(), kCamera);
    EXPECT_EQ(cameras[1].asString(), "camera:20.5,20.125,300:12.5,-60,0:60:1");
    EXPECT_EQ(picture_of(still / "method/00000.png").rgb,
              picture_of(flown / "method/00000.png").rgb);
}

TEST(Frames, run_flies_a_camera_too_and_refuses_what_is_none) {
    const ScratchFolder scratch;
    const fs::path scenario = tiny_scenario(scratch.path(), "repetitions = 1\n");
    const fs::path out = scratch.path() / "results";
    Finished done = run_lodbench({"run", scenario.string(), "-m", "full-grid", "--camera", kCamera,
                                  "--frames", "2", "--out", out.string()},
                                 scratch.path());
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_EQ(cells_of(out).at(0)["frames"].asInt(), 2);
    const Json::Value flight =
        results::parse_sealed(text_of(out / "flights/tiny.json"), "flights/tiny.json");
    EXPECT_EQ(flight["positions"][1][1].asDouble(), 20.125) << flight;
    const fs::path csv = scratch.path() / "path.csv";
    std::ofstream(csv) << "frame,x,y,z,heading,pitch,roll\n0,20.1,20.7,300.3,12.5,-60,0\n"
                          "1,20.30000000000001,20.7,300.3,12.5,-60,0\n";
    const fs::path recorded = scratch.path() / "recorded";
    done = run_lodbench({"run", scenario.string(), "-m", "full-grid", "--flight", csv.string(),
                         "--out", recorded.string()},
                        scratch.path());
    ASSERT_EQ(done.status, 0) << done.output;
    const Json::Value positions = results::parse_sealed(text_of(recorded / "flights/tiny.json"),
                                                        "flights/tiny.json")["positions"];
    ASSERT_EQ(positions.size(), 2U);
    EXPECT_EQ(positions[0][0].asDouble(), 20.1);
    EXPECT_NEAR(positions[1][0].asDouble(), 20.3, 1e-9);  // rounded for the record
    EXPECT_EQ(positions[1][2].asDouble(), 300.3);
    const fs::path mesh = scratch.path() / "mesh.ply";
    done = run_lodbench({"mesh", "full-grid", scenario.string(), "--flight", csv.string(),
                         "--frame", "1", "-o", mesh.string()},
                        scratch.path());
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_THAT(text_of(mesh),
                HasSubstr("camera_position_m 20.300000000000011 "));  // its 17 digits
    done = run_lodbench({"run", scenario.string(), "--camera", "camera:1,2"}, scratch.path());
    EXPECT_EQ(done.status, 2);
    EXPECT_THAT(done.output, HasSubstr("--camera: \"camera:1,2\" is no camera"));
}

TEST(Frames, a_method_that_crashes_is_named_with_call_and_frame) {
    const ScratchFolder scratch;
    const fs::path scenario = tiny_scenario(scratch.path(), "");
    const Finished done =
        run_lodbench({"frames", "segfaults", scenario.string(), "--plugin-dir",
                      broken_plugin_folder("segfaults"), "-o", (scratch.path() / "film").string()},
                     scratch.path());
    EXPECT_EQ(done.status, 3);
    EXPECT_THAT(done.output, HasSubstr("segmentation fault"));
    EXPECT_THAT(done.output, HasSubstr("in draw"));
}

}  // namespace
}  // namespace lodbench::test
