#include "support/mesh_tools.h"

namespace lodbench::test {
namespace {

const std::string kBroken = " --plugin-dir " LODBENCH_BUILD_DIR "/conformance-plugins ";
const std::string kRidged = "synthetic = \"ridged\"\nrows = 50\ncolumns = 70\nspacing = 10";

class MeshCommand : public MeshTest {
protected:
    std::string ridged(const std::string& more = "") {
        return scenario(kRidged, "[350, -200, 900]", "[350, 100, 800]", -35, more);
    }
};

TEST_F(MeshCommand, camera_in_the_header_projects_as_its_angles_do) {
    if (!has_numpy()) GTEST_SKIP() << "no numpy";
    const Outcome made =
        lodbench("mesh every-sample " + ridged() + " --frame 2 -o " + file("m.ply"));
    ASSERT_EQ(made.status, 0) << made.output;
    const Outcome checked = check_mesh(file("m.ply"));
    EXPECT_EQ(checked.status, 0) << checked.output;
    EXPECT_NE(checked.output.find("at pixel"), std::string::npos) << checked.output;
}

TEST_F(MeshCommand, header_names_method_parameters_terrain_and_frame) {
    const Outcome made = lodbench("mesh template " + ridged() +
                                  " --frame 1 --set template.step=2 -o " + file("m.ply"));
    ASSERT_EQ(made.status, 0) << made.output;
    const std::string text = read_bytes(file("m.ply"));
    for (const char* line :
         {"comment method template\n", "comment param step 2\n", "comment rows 50\n",
          "comment columns 70\n", "comment spacing_m 10 10\n", "comment frame 1\n",
          "comment viewport_px 320 240\n", "comment checksum ", "property double x\n"}) {
        EXPECT_NE(text.find(line), std::string::npos) << line;
    }
}

TEST_F(MeshCommand, size_sets_the_viewport) {
    const Outcome made =
        lodbench("mesh template " + ridged() + " --size 64x32 -o " + file("m.ply"));
    ASSERT_EQ(made.status, 0) << made.output;
    EXPECT_NE(read_bytes(file("m.ply")).find("comment viewport_px 64 32\n"), std::string::npos);
}

TEST_F(MeshCommand, two_runs_write_the_same_bytes) {
    for (const char* name : {"a.ply", "b.ply"}) {
        const Outcome made =
            lodbench("mesh every-sample " + ridged() + " --frame 2 -o " + file(name));
        ASSERT_EQ(made.status, 0) << made.output;
    }
    EXPECT_EQ(read_bytes(file("a.ply")), read_bytes(file("b.ply")));
}

TEST_F(MeshCommand, refuses_vertices_that_are_not_finite_and_counts_them) {
    const std::string down = scenario(kRidged, "[350, 200, 900]", "[350, 200, 901]", -90);
    const Outcome made =
        lodbench("mesh nan-straight-down" + kBroken + "" + down + " -o " + file("m.ply"));
    EXPECT_EQ(made.status, 3);
    // Two triangles for each of 49 x 69 cells, three vertices each.
    EXPECT_NE(made.output.find("20286 of the 20286 vertices"), std::string::npos) << made.output;
    EXPECT_FALSE(std::filesystem::exists(file("m.ply")));
}

TEST_F(MeshCommand, survives_a_method_that_aborts) {
    write_bytes(file("m.ply"), "as it was");
    const Outcome made = lodbench("mesh aborts" + kBroken + "" + ridged() + " -o " + file("m.ply"));
    EXPECT_EQ(made.status, 3);
    EXPECT_NE(made.output.find("broken_promises.so"), std::string::npos) << made.output;
    EXPECT_NE(made.output.find("signal 6"), std::string::npos) << made.output;
    EXPECT_EQ(read_bytes(file("m.ply")), "as it was");
}

TEST_F(MeshCommand, names_the_methods_when_one_is_misspelt) {
    const Outcome made = lodbench("mesh ful-grid " + ridged() + " -o " + file("m.ply"));
    EXPECT_EQ(made.status, 2);
    EXPECT_NE(made.output.find("'ful-grid'"), std::string::npos) << made.output;
    EXPECT_NE(made.output.find("every-sample"), std::string::npos) << made.output;
}

TEST_F(MeshCommand, refuses_a_frame_beyond_the_flight) {
    const Outcome made = lodbench("mesh template --frame 3 " + ridged() + " -o " + file("m.ply"));
    EXPECT_EQ(made.status, 2);
    EXPECT_NE(made.output.find("frames 0 to 2"), std::string::npos) << made.output;
}

TEST_F(MeshCommand, asks_for_one_value_of_a_swept_parameter) {
    const std::string swept = ridged("[[method]]\nid = \"template\"\nstep = [2, 4]\n");
    const Outcome asked = lodbench("mesh template " + swept + " -o " + file("m.ply"));
    EXPECT_EQ(asked.status, 2);
    EXPECT_NE(asked.output.find("--set step=2"), std::string::npos) << asked.output;
    EXPECT_EQ(lodbench("mesh template --set step=4 " + swept + " -o " + file("m.ply")).status, 0);
}

TEST_F(MeshCommand, names_the_file_that_cannot_be_written) {
    const Outcome made = lodbench("mesh template " + ridged() + " -o " + file("nowhere/m.ply"));
    EXPECT_NE(made.status, 0);
    EXPECT_NE(made.output.find("nowhere"), std::string::npos) << made.output;
}

}  // namespace
}  // namespace lodbench::test
