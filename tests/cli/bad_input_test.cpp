// Input that is wrong or was written to break the program: one message of one line on standard
// error, with the file, the line where there is one, the value and the remedy; nothing on standard
// output; status 2.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/raster_files.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Streams {
    int status = -1;
    std::string output, errors;
};

std::string repeated(const std::string& piece, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += piece;
    return text;
}

class BadInput : public testing::Test {
protected:
    [[nodiscard]] Streams lodbench(const std::vector<std::string>& arguments) const {
        const fs::path errors = folder_.path() / "errors.log";
        const Finished finished = run_lodbench(arguments, folder_.path(), [&] {
            if (chdir(folder_.path().c_str()) != 0) _exit(126);
            dup2(open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
        });
        return {finished.status, finished.output, text_of(errors)};
    }

    /// Where `message` is the beginning of all that is said.
    void expect_refused(const std::vector<std::string>& arguments,
                        const std::string& message) const {
        const Streams streams = lodbench(arguments);
        const std::string what = testing::PrintToString(arguments);
        EXPECT_EQ(streams.status, 2) << what << streams.errors.substr(0, 4000);
        EXPECT_EQ(streams.output, "") << what;
        EXPECT_THAT(streams.errors.substr(0, 4000), StartsWith("lodbench: " + message)) << what;
        EXPECT_LT(streams.errors.size(), 1000U) << what;
        EXPECT_EQ(streams.errors.find('\n') + 1, streams.errors.size())
            << what << "more than one line";
        for (const char c : streams.errors.substr(0, streams.errors.size() - 1)) {
            ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) << what;
        }
    }

    void expect_run_refused(const std::string& scenario, const std::string& message,
                            const std::string& method = "template") const {
        write("s.toml", scenario);
        fs::remove_all(folder_.path() / "out");
        expect_refused({"run", "s.toml", "--out", "out", "--method", method}, message);
    }

    /// Through `terrain info`, and through `run` from a scenario that names the file in its line 2.
    void expect_terrain_refused(const std::string& name, const std::string& message) const {
        expect_refused({"terrain", "info", name}, name + ": " + message);
        const std::string folder = folder_.path().string() + "/";
        expect_run_refused(scenario("file = \"" + name + "\""),
                           folder + "s.toml:2: " + folder + name + ": " + message);
    }

    fs::path write(const std::string& name, std::string_view bytes) const {
        std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
        return folder_.path() / name;
    }

    /// The table [terrain] has `terrain` in line 2; `more` begins in line 8.
    static std::string scenario(const std::string& terrain, const std::string& more = {}) {
        return "[terrain]\n" + terrain +
               "\n[flight]\nkind = \"line\"\nframes = 2\nstart = [0, 0, 300]\n"
               "end = [100, 0, 300]\n" +
               more;
    }

    ScratchFolder folder_;
};

const std::string kRamp = "synthetic = \"ramp\"";

TEST_F(BadInput, unknown_keys_name_the_known_ones) {
    expect_run_refused(scenario(kRamp, "[camera]\nfov = 3\n"),
                       "s.toml:9: [camera] \"fov\" is not a key of a scenario; known: ");
    expect_run_refused(scenario(kRamp, "[[method]]\nid = \"refined\"\nnope = 3\n"),
                       "s.toml:8: method 'refined' has no parameter 'nope'; known: ", "refined");
    write("a.raw", "12345678");
    write("a.raw.toml", "rows = 2\ncolumns = 2\nendain = \"big\"\n");
    expect_refused({"terrain", "info", "a.raw"}, "a.raw.toml:3: unknown key \"endain\"; known: ");
    write("a.raw.toml", "\"a\\n\\u001b[31m\" = 2\n");
    expect_refused({"terrain", "info", "a.raw"},
                   "a.raw.toml:1: unknown key \"a\\x0a\\x1b[31m\"; known: ");
}

TEST_F(BadInput, wrong_types_and_values_out_of_range_name_key_value_and_range) {
    expect_run_refused(scenario(kRamp, "[camera]\nnear = \"10\"\n"),
                       "s.toml:9: [camera] near = \"10\": text where a number from ");
    expect_run_refused(
        scenario(kRamp, "[camera]\nvertical_fov = 1000\n"),
        "s.toml:9: [camera] vertical_fov = 1000: out of range; write a number from ");
    expect_run_refused(scenario(kRamp, "[camera]\nnear = nan\n"),
                       "s.toml:9: [camera] near = nan: not a finite number; ");
    expect_run_refused(scenario(kRamp, "[viewport]\nwidth = 99999999999\n"),
                       "s.toml:9: [viewport] width = ");
    expect_run_refused(scenario(kRamp, "[[method]]\nid = \"refined\"\ntau = -1\n"),
                       "s.toml:8: '-1' is no value for parameter 'tau' of method 'refined'; give ",
                       "refined");
    write("a.raw", "12345678");
    write("a.raw.toml", "rows = 2\ncolumns = -2\n");
    expect_refused({"terrain", "info", "a.raw"}, "a.raw.toml:2: columns = -2; it must lie in ");
    write("a.raw.toml", "rows = 2\ntype = \"a\\nb\"\n");
    expect_refused({"terrain", "info", "a.raw"}, "a.raw.toml:2: type = \"a\\x0ab\"; known: ");
}

TEST_F(BadInput, missing_files_are_named) {
    expect_refused({"run", "none.toml", "--out", "out"}, "none.toml: no such file");
    expect_refused({"terrain", "info", "none.png"}, "none.png: no such file");
    expect_run_refused(scenario("file = \"none.png\""),
                       "s.toml:2: [terrain] file = \"none.png\": no such file");
}

TEST_F(BadInput, text_that_strains_the_parser_is_refused_at_its_line) {
    const std::pair<std::string, std::string> texts[] = {
        {repeated("a.", 40000) + "a = 1\n", "1: a line of 80005 bytes"},
        {"\n" + repeated("a.", 2000) + "a = 1\n", "2: a dotted key of more than "},
        {"\n\nx = \"" + std::string((1 << 20) - 100, 'y') + "\"\n", "3: a line of 1048482 bytes"},
        {"x = " + repeated("[", 100000), "1: a line of "},
        {"x = " + repeated("[\n", 100000), "65: brackets nested more than "},
        {"x = " + repeated("{a=", 1000), "1: brackets nested more than "},
        {"x = [\n1,\n", "2: not TOML: "},
        {std::string(500, '\0'), "1: not TOML: "},
    };
    for (const auto& [text, message] : texts) {
        expect_run_refused(text, "s.toml:" + message);
        write("a.raw", "12345678");
        write("a.raw.toml", text);
        expect_refused({"terrain", "info", "a.raw"}, "a.raw.toml:" + message);
    }
    expect_run_refused("x = \"" + std::string(1 << 20, 'y') + "\"\n",
                       "s.toml: longer than 1048576 bytes, the most that is read of TOML");
}

TEST_F(BadInput, sweeps_without_measure_are_refused_before_they_are_made) {
    std::string values = "[0";
    for (int i = 1; i < 1000; ++i) values += "," + std::to_string(i);
    const std::string sweep = "[[method]]\nid = \"refined\"\na = " + values + "]\nb = " + values +
                              "]\n[run]\nrepetitions = 1\n";
    expect_run_refused(scenario(kRamp, sweep),
                       "s.toml:8: the lists of method 'refined' and 1 repetitions make more than ",
                       "refined");
}

TEST_F(BadInput, rasters_that_make_no_surface_are_refused) {
    write("zero.pgm", "P5 0 0 255\n");
    write("row.pgm", "P5 5 1 255\n12345");
    write("huge.pgm", "P5 999999999999 999999999999 255\n1");
    expect_terrain_refused("zero.pgm", "0 rows x 0 columns make no surface");
    expect_terrain_refused("row.pgm", "1 rows x 5 columns make no surface");
    expect_terrain_refused("huge.pgm", "999999999999 rows x 999999999999 columns are more than ");
    const std::string sidecar = "rows = 2\ncolumns = 2\nendian = \"little\"\n";
    write("nan.raw", Bytes(false).real32(1).real32(2).real32(std::nanf("")).real32(4).str());
    write("nan.raw.toml", sidecar + "type = \"float32\"\n");
    expect_terrain_refused("nan.raw",
                           "the height at row 1, column 0 is nan; every height must be finite");
    write("void.raw", packed16({7, 7, 7, 7}, false));
    write("void.raw.toml", sidecar + "type = \"int16\"\nno_data = 7\n");
    expect_terrain_refused("void.raw", "every sample is no-data (7); check the no-data value");
    write("cut.raw", "1234567");
    write("cut.raw.toml", sidecar + "type = \"int16\"\n");
    expect_terrain_refused("cut.raw", "7 bytes, but 2 rows x 2 columns of 2 bytes make 8; ");
}

TEST_F(BadInput, damaged_images_are_refused) {
#ifndef LODBENCH_WITH_OIIO
    GTEST_SKIP() << "built without OpenImageIO";
#endif
    const std::string whole = png(2, 2, 8, 0, {"\x01\x02", "\x03\x04"});
    write("cut.png", whole.substr(0, whole.size() / 2));
    write("zero.png", png(0, 0, 8, 0, {}));
    write("row.png", png(5, 1, 8, 0, {"12345"}));
    write("huge.png", png(0x7FFFFFFF, 0x7FFFFFFF, 8, 0, {}));
    expect_terrain_refused("cut.png", "is truncated: it ends before its end chunk; ");
    expect_terrain_refused("zero.png", "0 rows x 0 columns are no size of a PNG; ");
    expect_terrain_refused("row.png", "1 rows x 5 columns make no surface");
    expect_terrain_refused("huge.png", "2147483647 rows x 2147483647 columns are more than ");
    write("nan.exr", exr(2, 2, {1, 2, 3, std::nanf("")}));
    expect_terrain_refused("nan.exr", "the height at row 1, column 1 is nan; ");
}

TEST_F(BadInput, damaged_elevation_models_are_refused) {
#ifndef LODBENCH_WITH_GDAL
    GTEST_SKIP() << "built without GDAL";
#endif
    const std::string whole =
        Tiff(2, 2, 16, 2, packed16({1, 2, 3, 4}, false)).place(30, 0, 0, false).str();
    write("cut.tif", whole.substr(0, whole.size() - 40));
    write("row.tif",
          Tiff(5, 1, 16, 2, packed16({1, 2, 3, 4, 5}, false)).place(30, 0, 0, false).str());
    expect_terrain_refused("cut.tif", "the data of tag ");
    const fs::path row = folder_.path() / "row.tif";
    expect_refused({"terrain", "info", row.string()},
                   row.string() + ": 1 rows x 5 columns make no surface");
    const fs::path text = write("words.asc", "ncols many\n");
    expect_refused({"terrain", "info", text.string()},
                   text.string() + ": line 1: ncols is \"many\"; expected one number");
}

}  // namespace
}  // namespace lodbench::test
