// pgm from cameras that put its screen grid to the test, judged on the exported mesh by a program
// that shares no code with it.

#include <fmt/format.h>

#include "support/mesh_tools.h"

namespace lodbench::test {
namespace {

// The terrain spans 0 .. 1280 m east and north; pgm's base plane is z = 0.
constexpr const char* kCameras =
    "frame,x,y,z,heading,pitch,roll\n"
    "0,300,200,900,30,0,0\n"        // level
    "1,640,640,1500,0,-90,0\n"      // straight down
    "2,640,640,900,100,60,0\n"      // upward: sky only
    "3,400,300,1200,45,-25,70\n"    // rolled
    "4,640,-200,0,0,0,0\n"          // on the plane
    "5,640,300,-250,10,20,0\n"      // under the plane
    "6,9000,-7000,600,315,-5,0\n";  // outside the terrain
constexpr const char* kNames[] = {
    "level",           "straight down",      "upward", "rolled", "on the plane",
    "under the plane", "outside the terrain"};

TEST_F(MeshTest, pgm_sends_whole_finite_grids_that_share_vertices_from_every_camera) {
    if (!has_numpy()) GTEST_SKIP() << "no numpy";
    write_bytes(file("cameras.csv"), kCameras);
    write_bytes(
        file("cameras.toml"),
        "[terrain]\nsynthetic = \"ridged\"\nrows = 129\ncolumns = 129\nspacing = 10\n"
        "[viewport]\nwidth = 320\nheight = 240\n"
        "[flight]\nkind = \"recorded\"\nfile = \"cameras.csv\"\nframes = 7\nwarmup_frames = 0\n");
    // 60 x 80 vertices with two triangles to each of 59 x 79 cells: what is above the horizon as
    // well.
    const std::string count = fmt::format("element face {}\n", 2 * 59 * 79);
    const std::string shares = fmt::format(" --shares-vertices {}", 2 * (59 + 79));
    for (std::size_t frame = 0; frame < std::size(kNames); ++frame) {
        const Outcome made =
            lodbench(fmt::format("mesh pgm --before-clipping --set grid=60 --set aspect=1.3333 "
                                 "--frame {} {} -o {}",
                                 frame, file("cameras.toml"), file("m.ply")));
        ASSERT_EQ(made.status, 0) << kNames[frame] << ": " << made.output;
        EXPECT_NE(read_bytes(file("m.ply")).find(count), std::string::npos)
            << kNames[frame] << ": " << made.output;
        const Outcome checked = check_mesh(file("m.ply") + shares);
        EXPECT_EQ(checked.status, 0) << kNames[frame] << ": " << checked.output;
    }
}

}  // namespace
}  // namespace lodbench::test
