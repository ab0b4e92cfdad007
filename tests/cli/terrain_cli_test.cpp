// `lodbench terrain` as a person types it: exit status, the one message, and what is printed.

#include <gtest/gtest.h>
#include <json/json.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "support/raster_files.h"

namespace {

struct Outcome {
    int status = -1;
    std::string text;  ///< standard output, then standard error
};

class TerrainCommand : public testing::Test {
protected:
    Outcome run(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.path().string() +
                                    "' && { '" LODBENCH_BINARY "' terrain " + arguments +
                                    " ; } 2>&1";
        Outcome outcome;
        std::FILE* pipe = popen(command.c_str(), "r");
        std::array<char, 4096> buffer{};
        for (std::size_t got = 0; (got = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
            outcome.text.append(buffer.data(), got);
        }
        const int status = pclose(pipe);
        outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return outcome;
    }
    /// The object in the output: a warning may stand before it, on standard error.
    static Json::Value parsed(const std::string& text) {
        Json::Value value;
        std::istringstream(text.substr(std::min(text.find('{'), text.size()))) >> value;
        return value;
    }
    lodbench::test::TemporaryFolder folder_;
};

TEST_F(TerrainCommand, info_prints_size_range_spacing_and_checksum) {
    const Outcome outcome =
        run("info --synthetic bump --rows 3 --columns 5 --set height=7 --spacing 2");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.text.find("size      3 rows x 5 columns\nheights   0 to 7 m\n"
                                "spacing   2 m east, 2 m north\n"),
              std::string::npos)
        << outcome.text;
}

TEST_F(TerrainCommand, synth_import_and_info_agree) {
    const Outcome synth = run("synth ridged --rows 17 --columns 33 --seed 4 -o a.raw --json");
    ASSERT_EQ(synth.status, 0) << synth.text;
    const Outcome import = run("import a.raw -o b.raw --json");
    ASSERT_EQ(import.status, 0) << import.text;
    const Outcome info = run("info b.raw --json");
    ASSERT_EQ(info.status, 0) << info.text;
    const Json::Value last = parsed(info.text);
    EXPECT_EQ(last["checksum"], parsed(synth.text)["checksum"]);
    EXPECT_EQ(last["rows"].asInt(), 17);
    EXPECT_EQ(last["columns"].asInt(), 33);
    EXPECT_EQ(last["spacing_m"][0].asDouble(), 10.0);
    EXPECT_EQ(parsed(import.text)["written"].asString(), "b.raw");
    EXPECT_TRUE(last["written"].isNull());
}

TEST_F(TerrainCommand, import_takes_overrides) {
    folder_.write("a.pgm", "P5 2 2 255\n\x01\x02\x03\x04");
    const Outcome import =
        run("import a.pgm --spacing 30 --spacing-y 20 --vertical-scale 10 "
            "--vertical-offset=-5 --no-data 4 --origin-x 100 -o b.raw --json");
    ASSERT_EQ(import.status, 0) << import.text;
    const Json::Value json = parsed(import.text);
    EXPECT_EQ(json["spacing_m"][0].asDouble(), 30.0);
    EXPECT_EQ(json["spacing_m"][1].asDouble(), 20.0);
    EXPECT_EQ(json["min_height_m"].asDouble(), 5.0);
    EXPECT_EQ(json["max_height_m"].asDouble(), 25.0);
    EXPECT_EQ(json["voids_filled"].asInt(), 1);
    EXPECT_EQ(json["extent_min_m"][0].asDouble(), 100.0);
}

TEST_F(TerrainCommand, info_says_when_it_assumed_the_spacing) {
    folder_.write("a.pgm", "P5 2 2 255\n\x01\x02\x03\x04");
    EXPECT_NE(run("info a.pgm").text.find("(assumed: the file does not say; give --spacing)"),
              std::string::npos);
    EXPECT_EQ(run("info a.pgm --spacing 1").text.find("assumed"), std::string::npos);
}

TEST_F(TerrainCommand, mistakes_end_with_status_2_and_one_line) {
    folder_.write("cut.raw", "123");
    folder_.write("cut.raw.toml", "rows = 2\ncolumns = 2\ntype = \"int16\"\nendian = \"big\"\n");
    const std::pair<const char*, const char*> mistakes[] = {
        {"info none.png", "lodbench: none.png: no such file\n"},
        {"info --synthetic plane --rows 1",
         "lodbench: synthetic terrain 'plane': 1 rows x 1025 columns make no surface; at least 2 x "
         "2 "
         "samples are needed\n"},
        {"info --synthetic plane --set height",
         "lodbench: --set height: expected key=value with a number for the value\n"},
        {"info --synthetic plane --set height=1 --set height=2",
         "lodbench: --set height=2: the key is set twice; set it once\n"},
        {"info cut.raw",
         "lodbench: cut.raw: 3 bytes, but 2 rows x 2 columns of 2 bytes make 8; the file is "
         "truncated "
         "or its size is given wrongly\n"},
        {"info cut.raw --seed 3",
         "lodbench: --seed: belongs to synthetic terrains; leave it out or name one with "
         "--synthetic\n"},
        {"synth plane -o a.tif",
         "lodbench: a.tif: heights are written as .raw; give a name that ends so\n"},
        {"info", "lodbench: terrain: neither a file nor a synthetic form is named\n"},
    };
    for (const auto& [arguments, message] : mistakes) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.text, message) << arguments;
    }
    EXPECT_EQ(run("info --rows many").status, 2);
    EXPECT_EQ(run("").status, 2);
}

TEST_F(TerrainCommand, a_failed_import_leaves_no_file) {
    folder_.write("a.pgm", "P5 2 2 255\n\x01\x02");
    EXPECT_EQ(run("import a.pgm -o b.raw").status, 2);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(TerrainCommand, a_full_disk_is_told_and_leaves_no_file) {
    // A limit on the size of files stands in for the full disk; its signal is ignored, so that
    // write fails.
    const Outcome outcome =
        run("info --synthetic plane >/dev/null; trap '' XFSZ; ulimit -f 8; "
            "'" LODBENCH_BINARY "' terrain synth plane -o a.raw");
    EXPECT_EQ(outcome.status, 4);
    EXPECT_NE(outcome.text.find("a.raw: cannot be written: File too large"), std::string::npos)
        << outcome.text;
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(TerrainCommand, help_lists_every_form_and_parameter) {
    const Outcome outcome = run("synth --help");
    EXPECT_EQ(outcome.status, 0);
    for (const char* word : {"sphere-cap", "radius", "persistence", "--set", "--seed", "--json"}) {
        EXPECT_NE(outcome.text.find(word), std::string::npos) << word;
    }
}

}  // namespace
