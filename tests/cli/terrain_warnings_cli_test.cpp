// What is doubtful about a terrain is said in words: on the terminal, and where results are kept.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/raster_files.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class TerrainWarnings : public testing::Test {
protected:
    /// 17 x 17 samples of 16 bits, heights from 1000 m, `marks` of them -9999.
    void write_raster(int marks, const std::string& more = "") const {
        std::vector<int> samples;
        for (int i = 0; i < 17 * 17; ++i) samples.push_back(i < marks ? -9999 : 1000 + i);
        std::ofstream(folder_.path() / "a.raw", std::ios::binary) << packed16(samples, true);
        std::ofstream(folder_.path() / "a.raw.toml")
            << "rows = 17\ncolumns = 17\ntype = \"int16\"\nendian = \"big\"\nspacing = 10\n"
            << more;
    }
    Finished terrain(const std::vector<std::string>& arguments) const {
        std::vector<std::string> all = {"terrain"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        return run_lodbench(all, folder_.path());
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    /// Two cells over the terrain `name`.
    Finished run(const std::string& name, const std::vector<std::string>& more = {}) const {
        std::ofstream(folder_.path() / "tiny.toml")
            << "[terrain]\nfile = \"" << name << "\"\n"
            << "[viewport]\nwidth = 32\nheight = 24\n[flight]\nkind = \"line\"\nframes = 2\n"
               "warmup_frames = 0\nstart = [20, 20, 3000]\nend = [100, 100, 3000]\npitch = -60\n";
        std::vector<std::string> arguments = {
            "run",      file("tiny.toml"), "--out",    file("out"),
            "--method", "template",        "--repeat", "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder_.path());
    }
    [[nodiscard]] Json::Value warnings_of_run() const {
        return results::parse_json(text_of(folder_.path() / "out" / "run.json"),
                                   "run.json")["warnings"];
    }
    static std::size_t count(const std::string& text, const std::string& part) {
        std::size_t found = 0;
        for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
            ++found;
        return found;
    }
    ScratchFolder folder_;
};

TEST_F(TerrainWarnings, stand_on_the_terminal_and_in_json) {
    write_raster(2);
    const std::string warning = "a.raw: 2 samples are -9999, the first at row 0, column 0";
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"info", file("a.raw")},
          {"import", file("a.raw"), "-o", file("b.raw")},
          {"import", file("a.raw"), "-o", file("b.tiles")}}) {
        const Finished finished = terrain(arguments);
        EXPECT_EQ(finished.status, 0) << finished.output;
        EXPECT_THAT(finished.output, HasSubstr("warning: " + file(warning))) << arguments[0];
        EXPECT_EQ(count(finished.output, "warning: "), 1U) << finished.output;
    }
    const Finished finished = terrain({"info", file("a.raw"), "--json"});
    const std::string text = finished.output.substr(finished.output.find('{'));
    const Json::Value json = results::parse_json(text, "standard output");
    ASSERT_EQ(json["warnings"].size(), 1U);
    EXPECT_THAT(json["warnings"][0].asString(), HasSubstr(warning));
    EXPECT_TRUE(json["reference"].isNull());
    EXPECT_EQ(json["world"].asString(), "x is east, y north, z up, in metres");
}

TEST_F(TerrainWarnings, are_none_where_nothing_is_doubtful) {
    write_raster(0);
    const Finished finished = terrain({"info", file("a.raw")});
    EXPECT_THAT(finished.output, Not(HasSubstr("warning")));
    EXPECT_THAT(finished.output, HasSubstr("world     x is east, y north, z up, in metres; the "
                                           "south-west sample stands at (0.00, 0.00)\n"));
}

TEST_F(TerrainWarnings, of_a_run_stand_on_the_terminal_and_in_its_results_once) {
    write_raster(2);
    const Finished finished = run("a.raw");
    ASSERT_EQ(finished.status, 0) << finished.output;
    const std::string words = "a.raw: 2 samples are -9999";
    EXPECT_EQ(count(finished.output, "warning: "), 1U) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr(words));
    const Json::Value warnings = warnings_of_run();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_THAT(warnings[0].asString(), HasSubstr(words));
    EXPECT_THAT(text_of(folder_.path() / "out" / "summary.md"), HasSubstr("Warnings: 1"));
    // Nothing is left to fly, and the warning is still there.
    EXPECT_EQ(run("a.raw", {"--resume"}).status, 0);
    EXPECT_EQ(warnings_of_run(), warnings);
}

TEST_F(TerrainWarnings, of_many_voids_outlive_an_import) {
    write_raster(100, "no_data = -9999\n");
    const std::string words =
        "terrain 'a': 34.6 % of its samples (100) had no data and were filled from their "
        "neighbours: what is measured there is no terrain";
    EXPECT_THAT(terrain({"import", file("a.raw"), "-o", file("a.tiles")}).output, HasSubstr(words));
    EXPECT_THAT(terrain({"info", file("a.tiles")}).output, HasSubstr(words));
    const Finished finished = run("a.tiles");
    ASSERT_EQ(finished.status, 0) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("warning: " + words));
    ASSERT_EQ(warnings_of_run().size(), 1U);
    EXPECT_EQ(warnings_of_run()[0].asString(), words) << "as `terrain info` has it";
}

}  // namespace
}  // namespace lodbench::test
