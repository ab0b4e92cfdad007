// What `run` says of a terrain it cannot fly and of a device that is not there, and how it goes on
// when mended; `list` and `describe` for programs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/files.h"
#include "support/raster_files.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

class BadTerrain : public testing::Test {
protected:
    /// Three frames over the file, which lies beside the scenario.
    fs::path scenario(const std::string& terrain) const {
        return folder_.write("bad.toml",
                             "[terrain]\nfile = \"" + terrain +
                                 "\"\nspacing = 10\n[viewport]\nwidth = 32\nheight = 24\n"
                                 "[flight]\nkind = \"line\"\nframes = 3\nwarmup_frames = 0\n"
                                 "start = [0, 0, 500]\nend = [10, 10, 500]\npitch = -60\n"
                                 "[run]\nrepetitions = 2\n");
    }
    Finished run(const std::string& terrain, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments = {"run",      scenario(terrain).string(),
                                              "--out",    out().string(),
                                              "--method", "every-sample",
                                              "--method", "refined"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder_.path());
    }
    [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }

    /// Exit status 2, one message with all the parts, and nothing left behind; once `mend` has run,
    /// the same command flies all.
    template <typename Mend>
    void expect_refused_until_mended(const std::string& terrain,
                                     const std::vector<std::string>& parts,
                                     const Mend& mend) const {
        const Finished refused = run(terrain);
        EXPECT_EQ(refused.status, 2) << refused.output;
        for (const std::string& part : parts) EXPECT_THAT(refused.output, HasSubstr(part));
        EXPECT_EQ(std::ranges::count(refused.output, '\n'), 1) << refused.output;
        EXPECT_FALSE(fs::exists(out())) << "the same command must do once the file is mended";
        mend();
        const Finished resumed = run(terrain);
        EXPECT_EQ(resumed.status, 0) << resumed.output;
        std::set<std::string> cells;
        for (const Json::Value& cell : cells_of(out())) {
            EXPECT_EQ(cell["status"].asString(), "ok") << cell["reason"];
            EXPECT_TRUE(cells.insert(cell["cell"].asString()).second);
        }
        EXPECT_EQ(cells.size(), 4U);
    }

    void write_heights(float seventh) const {
        Bytes bytes(false);
        for (int i = 0; i < 25; ++i) bytes.real32(i == 7 ? seventh : float(i));
        folder_.write("heights.raw", bytes.str());
        folder_.write("heights.raw.toml",
                      "rows = 5\ncolumns = 5\ntype = \"float32\"\nendian = \"little\"\n");
    }

    TemporaryFolder folder_;
};

TEST_F(BadTerrain, heights_that_are_nan_are_refused_with_row_and_column) {
    write_heights(std::numeric_limits<float>::quiet_NaN());
    expect_refused_until_mended(
        "heights.raw", {"bad.toml:2: ", "heights.raw: ", "row 1, column 2", "nan", "no-data"},
        [&] { write_heights(7); });
}

#ifdef LODBENCH_WITH_OIIO
TEST_F(BadTerrain, truncated_png_is_refused) {
    const std::string whole =
        png(5, 5, 8, 0, std::vector<std::string>(5, std::string("\1\2\3\4\5")));
    folder_.write("cut.png", std::string_view(whole).substr(0, whole.size() - 9));
    expect_refused_until_mended("cut.png", {"bad.toml:2: ", "cut.png: ", "is truncated", "anew"},
                                [&] { folder_.write("cut.png", whole); });
}
#endif

TEST_F(BadTerrain, one_row_is_refused) {
    write_heights(7);
    folder_.write("heights.raw.toml",
                  "rows = 1\ncolumns = 25\ntype = \"float32\"\nendian = \"little\"\n");
    expect_refused_until_mended("heights.raw",
                                {"bad.toml:2: ", "heights.raw.toml:1: rows = 1", "2 to"},
                                [&] { write_heights(7); });
}

TEST_F(BadTerrain, device_that_is_not_there_ends_with_status_4_and_what_was_tried) {
    write_heights(7);
    const Finished finished = run("heights.raw", {"--device", "nosuch"});
    EXPECT_EQ(finished.status, 4) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("for device 'nosuch': device 0 ("));
    EXPECT_THAT(finished.output, HasSubstr("which does not contain 'nosuch'"));
    EXPECT_FALSE(fs::exists(out())) << "the same command must do with another device";
    EXPECT_EQ(run("heights.raw").status, 0);
}

TEST_F(BadTerrain, mistakes_of_usage_end_with_status_2_and_leave_no_folder) {
    write_heights(7);
    const std::pair<std::vector<std::string>, const char*> mistakes[] = {
        {{"--method", "nosuch"}, "no method 'nosuch' was found; known: "},
        {{"--set", "refined.nosuch=1"}, "nosuch"},
        {{"--set", "refined.tau=far"}, "far"},
        {{"--set", "strided.vertices=24"}, "'strided' is not flown in this run"},
        {{"--size", "0x24"}, "--size 0x24: expected WIDTHxHEIGHT"},
        {{"--seed", "-1"}, "--seed -1: expected a whole number"},
        {{"--set", "refined.tau=1", "--set", "refined.tau=2"}, "refined.tau is set twice"},
        {{"--frames", "0"}, "--frames"},
        {{"--repeat", "0"}, "--repeat"},
    };
    for (const auto& [arguments, message] : mistakes) {
        const Finished finished = run("heights.raw", arguments);
        EXPECT_EQ(finished.status, 2) << finished.output;
        EXPECT_THAT(finished.output, HasSubstr(message));
        EXPECT_FALSE(fs::exists(out())) << message;
    }
}

TEST_F(BadTerrain, terrain_that_changes_before_a_resume_is_refused_with_both_checksums) {
    write_heights(7);
    ASSERT_EQ(run("heights.raw").status, 0);
    const std::vector<Json::Value> cells = cells_of(out());
    ASSERT_EQ(cells.size(), 4U);
    // As if killed before the last cell.
    const fs::path file = out() / "cells.jsonl";
    const std::string text = base::read_text(file);
    base::write_whole(file, text.substr(0, text.rfind('\n', text.size() - 2) + 1));
    write_heights(8);
    const Finished resumed =
        run_lodbench({"run", "--resume", "--out", out().string()}, folder_.path());
    EXPECT_EQ(resumed.status, 2) << resumed.output;
    EXPECT_THAT(resumed.output, HasSubstr("the terrain of scenario 'bad' has changed"));
    EXPECT_THAT(resumed.output, HasSubstr(cells[0]["terrain_checksum"].asString()));
    EXPECT_EQ(cells_of(out()).size(), 3U) << "finished cells are kept";
    write_heights(7);
    EXPECT_EQ(run_lodbench({"run", "--resume", "--out", out().string()}, folder_.path()).status, 0);
    EXPECT_EQ(cells_of(out()).size(), 4U);
}

TEST_F(BadTerrain, method_that_fails_ends_with_status_3_and_keeps_the_others) {
    write_heights(7);
    const Finished finished =
        run("heights.raw", {"--method", "throws-in-create", "--plugin-dir",
                            broken_plugin_folder("throws_in_create"), "--json"});
    EXPECT_EQ(finished.status, 3) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("\"exit_status\":3"));
    int good = 0;
    for (const Json::Value& cell : cells_of(out())) good += cell["status"] == "ok" ? 1 : 0;
    EXPECT_EQ(good, 4);
}

TEST(List, json_names_each_method_and_describe_each_parameter) {
    const ScratchFolder folder;
    const Finished listed = run_lodbench({"list", "--json"}, folder.path());
    ASSERT_EQ(listed.status, 0) << listed.output;
    const Json::Value json = results::parse_json(listed.output, "list");
    std::set<std::string> ids;
    for (const Json::Value& method : json["methods"]) ids.insert(method["id"].asString());
    EXPECT_THAT(ids, testing::IsSupersetOf({"every-sample", "refined", "strided", "template"}));
    for (const std::string& id : ids) {
        const Finished described = run_lodbench({"describe", id, "--json"}, folder.path());
        ASSERT_EQ(described.status, 0) << described.output;
        const Json::Value method = results::parse_json(described.output, "describe");
        EXPECT_EQ(method["id"].asString(), id);
        EXPECT_TRUE(method["params"].isArray());
        for (const Json::Value& param : method["params"]) {
            for (const char* key : {"name", "type", "help", "default"})
                EXPECT_TRUE(param.isMember(key)) << key;
        }
    }
    EXPECT_EQ(run_lodbench({"describe", "nosuch"}, folder.path()).status, 2);
}

TEST(List, devices_are_numbered_from_zero_and_say_whether_they_are_software) {
    const ScratchFolder folder;
    const Finished listed = run_lodbench({"list", "--devices", "--json"}, folder.path());
    ASSERT_EQ(listed.status, 0) << listed.output;
    const Json::Value json = results::parse_json(listed.output, "list");
    ASSERT_GE(json.size(), 1U);
    for (Json::ArrayIndex i = 0; i < json.size(); ++i) {
        EXPECT_EQ(json[i]["number"].asUInt(), i);
        EXPECT_FALSE(json[i]["name"].asString().empty());
        EXPECT_TRUE(json[i]["software"].isBool());
    }
}

}  // namespace
}  // namespace lodbench::test
