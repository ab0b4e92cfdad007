// `lodbench-terrain-errors` as a person types it.

#include <gtest/gtest.h>
#include <json/json.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>
#include <tuple>

#include "results/json.h"
#include "support/mesh_tools.h"
#include "support/raster_files.h"

namespace lodbench::test {
namespace {

class TerrainErrors : public testing::Test {
protected:
    [[nodiscard]] Outcome in_folder(const std::string& command) const {
        return run_command("cd '" + folder_.path().string() + "' && { " + command + " ; } 2>&1");
    }
    [[nodiscard]] Outcome run(const std::string& arguments) const {
        return in_folder("'" LODBENCH_BINARY "-terrain-errors' " + arguments);
    }
    TemporaryFolder folder_;
};

#ifdef LODBENCH_WITH_OIIO
TEST_F(TerrainErrors, are_what_an_independent_program_computes) {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) {
        GTEST_SKIP() << "no numpy";
    }
    const std::string check =
        "; /usr/bin/python3 " LODBENCH_SOURCE_DIR "/methods/common/tests/check_errors.py ";
    ASSERT_EQ(in_folder("'" LODBENCH_BINARY
                        "' terrain synth ridged --rows 129 --columns 129 --spacing 10 "
                        "--spacing-y 7 -o a.raw")
                  .status,
              0);
    for (const char* scheme : {"ppcs", "ppcs-plain", "rpcs"}) {
        for (const char* error : {"midpoint", "accumulated"}) {
            const Outcome outcome =
                run(std::string("a.raw -o a.exr --scheme ") + scheme + " --error " + error + check +
                    "a.raw a.exr 129 10 7 " + error);
            EXPECT_EQ(outcome.status, 0) << outcome.output;
            EXPECT_NE(outcome.output.find("a.exr: channels error and radius, metres\n129 x 129"),
                      std::string::npos)
                << outcome.output;
        }
    }
    // What was written for one kind is not taken for the other.
    EXPECT_EQ(run("a.raw -o a.exr" + check + "a.raw a.exr 129 10 7 accumulated").status, 1);
}

TEST_F(TerrainErrors, leaves_out_the_padding_and_no_part_of_a_file) {
    const Outcome outcome = run("--synthetic ridged --rows 30 --columns 50 -o a.exr --json");
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const Json::Value json =
        results::parse_json(outcome.output.substr(outcome.output.find("{")), "what was printed");
    EXPECT_EQ(json["padded_size"].asInt(), 65);
    EXPECT_EQ(json["rows"].asInt(), 30);
    EXPECT_GT(json["centre_radius_m"].asDouble(), 320.0);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
    EXPECT_EQ(run("--synthetic plane -o a.exr --scheme best").status, 2);
}
#endif

TEST_F(TerrainErrors, refuses_its_output_before_it_reads_or_computes_anything) {
    // No such terrains: whatever is said of them comes too late.
    for (const char* terrain : {"none.tif", "--synthetic mountain"}) {
        const std::string errors = std::string(terrain) + " -o ";
        const std::tuple<const char*, int, const char*> mistakes[] = {
            {"a.png", 2,
             "lodbench-terrain-errors: a.png: rasters of floats are written as .exr; give a name "
             "that ends so\n"},
            {"a", 2,
             "lodbench-terrain-errors: a: rasters of floats are written as .exr; give a name that "
             "ends so\n"},
            {"none/a.exr", 2,
             "lodbench-terrain-errors: none/a.exr: the folder none does not exist; make it "
             "first\n"},
            // Nobody may make a file there, root neither.
            {"/sys/a.exr", 4,
             "lodbench-terrain-errors: /sys/a.exr: the folder /sys takes no file: Permission "
             "denied; choose one "
             "that may be written to\n"}};
        for (const auto& [output, status, message] : mistakes) {
            const Outcome outcome = run(errors + output);
            EXPECT_EQ(outcome.status, status) << output;
            EXPECT_EQ(outcome.output, message) << output;
        }
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace lodbench::test
