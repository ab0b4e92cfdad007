// Stores as a person makes, looks at and flies them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "sanitizers/sanitizers.h"
#include "support/compare_truth.h"
#include "support/run_lodbench.h"
#include "support/tile_store_files.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;

class StoreCommand : public testing::Test {
protected:
    StoreCommand() { fs::create_directory(files_); }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (files_ / name).string();
    }
    Finished terrain(std::vector<std::string> arguments,
                     const std::function<void()>& prepare = {}) const {
        arguments.insert(arguments.begin(), "terrain");
        return run_lodbench(arguments, folder_.path(), prepare);
    }
    Json::Value json(const std::vector<std::string>& arguments) const {
        const Finished finished = terrain(arguments);
        EXPECT_EQ(finished.status, 0) << finished.output;
        // A warning may stand before the object, on standard error.
        const std::string& text = finished.output;
        return results::parse_json(text.substr(std::min(text.find('{'), text.size())), "output");
    }
    [[nodiscard]] std::size_t file_count() const {
        return std::size_t(std::distance(fs::directory_iterator(files_), {}));
    }
    void synth(const std::string& name, const std::string& size = "300") const {
        const Finished made =
            terrain({"synth", "ridged", "--rows", size, "--columns", "200", "-o", file(name)});
        ASSERT_EQ(made.status, 0) << made.output;
    }
    /// A scenario over a store; `more` is more text for its table [terrain].
    [[nodiscard]] fs::path scenario(const std::string& store, const std::string& more = "",
                                    const std::string& flight = "") const {
        const fs::path path = folder_.path() / "s.toml";
        std::ofstream(path)
            << "[terrain]\nfile = \"" << file(store) << "\"\n"
            << more << R"(
[viewport]
width = 64
height = 48
[flight]
frames = 3
warmup_frames = 1
)"
            << (flight.empty()
                    ? "kind = \"orbit\"\nrelative = true\ncentre = [0.5, 0.5]\nradius = 2000\n"
                      "height = 1500\n"
                    : flight)
            << "[run]\nrepetitions = 1\n";
        return path;
    }

    ScratchFolder folder_;
    fs::path files_ = folder_.path() / "files";
};

TEST_F(StoreCommand, what_is_imported_is_what_info_shows_and_verify_finds_sound) {
    synth("a.raw");
    const Json::Value raw = json({"info", file("a.raw"), "--json"});
    const Json::Value made = json({"import", file("a.raw"), "-o", file("a.tiles"), "--json"});
    const Json::Value shown = json({"info", file("a.tiles"), "--json"});
    for (const char* field :
         {"name", "rows", "columns", "min_height_m", "max_height_m", "spacing_m", "extent_min_m",
          "extent_max_m", "voids_filled", "checksum"}) {
        EXPECT_EQ(made[field], raw[field]) << field;
        EXPECT_EQ(shown[field], raw[field]) << field;
    }
    EXPECT_EQ(shown["source"].asString(), "tiled store, float32");
    EXPECT_EQ(shown["store"]["levels"].asInt(), 4);
    EXPECT_EQ(shown["store"]["tiles"].asInt(), 5 * 4 + 3 * 2 + 2 + 1);
    EXPECT_EQ(shown["store"]["tile_bytes"].asInt(), 16900);
    EXPECT_EQ(shown["store"]["bytes"].asUInt64(), fs::file_size(file("a.tiles")));
    EXPECT_TRUE(shown["store"]["step_m"].isNull());
    EXPECT_EQ(made["written"].asString(), file("a.tiles"));

    const Finished words = terrain({"info", file("a.tiles")});
    EXPECT_THAT(words.output, HasSubstr("samples   float32\nlevels    4: 5 x 4 3 x 2 2 x 1 1 x 1\n"
                                        "tiles     29 of 16900 bytes\n"));
    const Finished sound = terrain({"verify", file("a.tiles")});
    EXPECT_EQ(sound.status, 0);
    EXPECT_THAT(sound.output, HasSubstr(": 29 tiles, 0 faults, "));
    EXPECT_THAT(sound.output, HasSubstr(" MB/s\n"));

    // And back, and as steps, from a store too.
    EXPECT_EQ(json({"import", file("a.tiles"), "-o", file("b.raw"), "--json"})["checksum"],
              raw["checksum"]);
    const Json::Value steps =
        json({"import", file("a.tiles"), "-o", file("b.tiles"), "--step", "0.25", "--json"});
    EXPECT_NE(steps["checksum"], raw["checksum"]);
    EXPECT_EQ(steps["store"]["step_m"].asDouble(), 0.25);
    EXPECT_EQ(steps["store"]["tile_bytes"].asInt(), 8450);
    EXPECT_EQ(json({"verify", file("b.tiles"), "--json"})["fault_count"].asInt(), 0);
    // Stores serve where rasters do.
    EXPECT_EQ(json({"import", file("b.tiles"), "-o", file("c.raw"), "--json"})["checksum"],
              steps["checksum"]);
}

TEST_F(StoreCommand, voids_are_filled_as_in_memory) {
    std::ofstream(file("v.pgm"), std::ios::binary) << "P5 3 3 255\n"
                                                   << "\x01\x02\x03\x04\x09\x06\x07\x08\x05";
    const std::vector<std::string> how = {"--no-data", "9", "--spacing", "2"};
    std::vector<std::string> raw = {"import", file("v.pgm"), "-o", file("v.raw"), "--json"};
    std::vector<std::string> tiles = {"import", file("v.pgm"), "-o", file("v.tiles"), "--json"};
    raw.insert(raw.end(), how.begin(), how.end());
    tiles.insert(tiles.end(), how.begin(), how.end());
    const Json::Value one = json(raw), other = json(tiles);
    EXPECT_EQ(one["checksum"], other["checksum"]);
    EXPECT_EQ(other["voids_filled"].asInt(), 1);
    EXPECT_EQ(json({"info", file("v.tiles"), "--json"})["voids_filled"].asInt(), 1);
}

TEST_F(StoreCommand, upsample_is_the_same_from_a_raster_and_from_a_store) {
    synth("a.raw");
    ASSERT_EQ(terrain({"import", file("a.raw"), "-o", file("a.tiles")}).status, 0);
    const std::vector<std::string> how = {"--factor", "4",      "--fractal", "3",     "--seed",
                                          "2",        "--rows", "1000",      "--json"};
    const auto from = [&](const char* source, const char* result) {
        std::vector<std::string> arguments = {"upsample", file(source), "-o", file(result)};
        arguments.insert(arguments.end(), how.begin(), how.end());
        return json(arguments);
    };
    const Json::Value one = from("a.raw", "1.tiles"), other = from("a.tiles", "2.tiles");
    EXPECT_EQ(one["checksum"], other["checksum"]);
    EXPECT_EQ(one["rows"].asInt(), 1000);
    EXPECT_EQ(one["columns"].asInt(), 199 * 4 + 1);
    EXPECT_EQ(one["spacing_m"][0].asDouble(), 2.5);
    EXPECT_EQ(one["extent_max_m"][1].asDouble(), 2990.0) << "the north edge stays";
    EXPECT_EQ(bytes_of(file("1.tiles")).substr(1024), bytes_of(file("2.tiles")).substr(1024));
    EXPECT_EQ(terrain({"verify", file("1.tiles")}).status, 0);
}

TEST_F(StoreCommand, verify_names_damaged_tiles_and_ends_with_status_1) {
    synth("a.tiles");
    std::string bytes = bytes_of(file("a.tiles"));
    const terrain::StoreLayout layout(300, 200, {});
    for (const TileId& tile : {TileId{0, 2, 1}, TileId{0, 3, 0}, TileId{1, 0, 0}}) {
        bytes[layout.offset(tile) + 1000] ^= 1;
    }
    write_bytes(file("a.tiles"), bytes);
    const Finished found = terrain({"verify", file("a.tiles")});
    EXPECT_EQ(found.status, 1);
    for (const char* name :
         {"level 0, row 2, column 1", "level 0, row 3, column 0", "level 1, row 0, column 0"}) {
        EXPECT_THAT(found.output,
                    HasSubstr(file("a.tiles") + ": tile (" + name + "): the checksum is "));
    }
    EXPECT_THAT(found.output, HasSubstr(": 29 tiles, 3 faults, "));
    const Finished few = terrain({"verify", file("a.tiles"), "--most", "1"});
    EXPECT_EQ(few.status, 1);
    EXPECT_THAT(few.output, HasSubstr(": 2 more\n"));
    // Header and index are looked at first.
    write_bytes(file("a.tiles"), bytes.substr(0, bytes.size() - 1));
    const Finished cut = terrain({"verify", file("a.tiles")});
    EXPECT_EQ(cut.status, 2);
    EXPECT_THAT(cut.output, HasSubstr("it is truncated, fetch or build it anew"));
}

TEST_F(StoreCommand, mistakes_end_with_status_2_and_no_file) {
    synth("a.raw", "10");
    const std::size_t before = file_count();
    const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes = {
        {{"import", file("a.raw"), "-o", file("b.raw"), "--step", "1"},
         "--step 1: belongs to tiled stores; write OUT.tiles"},
        {{"import", file("a.raw"), "-o", file("b.tiles"), "--step", "0"}, "a step of 0 m"},
        {{"import", file("a.raw"), "-o", file("b.tiles"), "--step", "0.001"},
         "more than 65535 steps of 0.001 m apart: these rows alone need a step of 0.0"},
        {{"upsample", file("a.raw"), "-o", file("b.raw")}, "tiled stores are written as .tiles"},
        {{"upsample", file("a.raw"), "-o", file("b.tiles"), "--factor", "3", "--fractal", "1"},
         "a fractal and a factor of 3"},
        {{"import", file("a.raw"), "-o", file("none/b.tiles")}, "does not exist; make it first"},
        {{"verify", file("a.raw")}, "not a tiled store (.tiles)"},
        {{"verify", file("none.tiles")}, "cannot be opened for reading: No such file"},
    };
    for (const auto& [arguments, words] : mistakes) {
        const Finished finished = terrain(arguments);
        EXPECT_EQ(finished.status, 2) << words;
        EXPECT_THAT(finished.output, HasSubstr(words));
        EXPECT_EQ(file_count(), before) << words;
    }
}

TEST_F(StoreCommand, a_full_disk_is_told_at_once_and_leaves_what_was_there) {
    write_bytes(file("a.tiles"), "what was there");
    const auto limit = [] {
        const rlimit bytes{16 << 10, 16 << 10};
        setrlimit(RLIMIT_FSIZE, &bytes);
        signal(SIGXFSZ, SIG_IGN);
    };
    const Finished finished = terrain(
        {"synth", "ridged", "--rows", "300", "--columns", "200", "-o", file("a.tiles")}, limit);
    EXPECT_EQ(finished.status, 4);
    EXPECT_THAT(finished.output, HasSubstr("a.tiles: cannot be written: File too large"));
    EXPECT_EQ(bytes_of(file("a.tiles")), "what was there");
    EXPECT_EQ(file_count(), 1U);
}

TEST_F(StoreCommand, a_killed_import_leaves_nothing) {
    synth("a.tiles");
    write_bytes(file("b.tiles"), "what was there");
    // 19137 x 12737 samples: seconds of work.
    const pid_t child = start_lodbench({"terrain", "upsample", file("a.tiles"), "-o",
                                        file("b.tiles"), "--factor", "64", "--step", "0.5"},
                                       folder_.path() / "log");
    std::this_thread::sleep_for(std::chrono::milliseconds(400 * kSlowness));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it was over too soon: " << text_of(folder_.path() / "log");
    EXPECT_EQ(bytes_of(file("b.tiles")), "what was there");
    EXPECT_EQ(file_count(), 2U);
}

TEST_F(StoreCommand, a_store_is_flown_and_measured_as_the_same_terrain_in_memory) {
    synth("a.raw");
    ASSERT_EQ(terrain({"import", file("a.raw"), "-o", file("a.tiles")}).status, 0);
    std::vector<Json::Value> cells;
    for (const char* name : {"a.raw", "a.tiles"}) {
        const fs::path out = folder_.path() / "out" / name;
        const Finished finished = run_lodbench(
            {"run", scenario(name).string(), "--out", out.string(), "--method", "refined"},
            folder_.path());
        ASSERT_EQ(finished.status, 0) << finished.output;
        cells.push_back(cells_of(out).at(0));
    }
    for (const char* field :
         {"depth_hash", "terrain_checksum", "triangles", "samples_served", "tiles_served",
          "screen_error_px", "pixel_error_px", "crack_pixels", "image"}) {
        EXPECT_EQ(cells[0][field], cells[1][field]) << field;
    }
    EXPECT_EQ(cells[0]["terrain_bytes_read"].asUInt64(), 0U);
    // refined reads the whole: each tile of level 0 at least once.
    EXPECT_GE(cells[1]["terrain_bytes_read"].asUInt64(), 5U * 4 * 16900);
    EXPECT_EQ(cells[1]["samples_served"].asUInt64(), 300U * 200);
}

TEST_F(StoreCommand, the_harness_itself_reads_nothing_on_the_method_s_account) {
    synth("a.tiles");
    const fs::path out = folder_.path() / "out";
    // The path follows the ground, the truth takes the whole: neither is the method's.
    const Finished finished =
        run_lodbench({"run",
                      scenario("a.tiles", "cold = true\n",
                               "kind = \"terrain-following\"\nrelative = true\nstart = [0.2, 0.2]\n"
                               "end = [0.8, 0.8]\nheight = 500\n")
                          .string(),
                      "--out", out.string(), "--method", "reads-tiles", "--plugin-dir",
                      broken_plugin_folder("reads_tiles")},
                     folder_.path());
    ASSERT_EQ(finished.status, 0) << finished.output;
    const Json::Value cell = cells_of(out).at(0);
    // In prepare, for the warm-up frame and for each of the three of the timing replay.
    EXPECT_EQ(cell["tiles_served"].asInt(), 5);
    EXPECT_EQ(cell["samples_served"].asInt(), 5 * 65 * 65);
    EXPECT_EQ(cell["terrain_bytes_read"].asInt(), 5 * 65 * 65 * 4);
}

TEST_F(StoreCommand, that_fails_while_it_is_flown_ends_that_cell_with_the_tile_s_name) {
    for (const auto& [accident, words] :
         {std::pair{"truncate", "lie beyond the end of the file, which has been truncated"},
          {"read_error", "cannot be read: Is a directory"}}) {
        synth("a.tiles");
        const fs::path out = folder_.path() / accident;
        const Finished finished = run_lodbench(
            {"run", scenario("a.tiles").string(), "--no-truth", "--out", out.string(), "--method",
             "reads-tiles", "--plugin-dir", broken_plugin_folder("reads_tiles")},
            folder_.path(),
            [accident = accident] { setenv("LODBENCH_TEST_ACCIDENT", accident, 1); });
        EXPECT_EQ(finished.status, 3) << finished.output;
        const Json::Value cell = cells_of(out).at(0);
        EXPECT_EQ(cell["status"].asString(), "failed");
        EXPECT_THAT(cell["reason"].asString(),
                    testing::StartsWith("select of plugin reads_tiles.so threw: " +
                                        file("a.tiles") + ": tile (level 0, row 0, column 1): "));
        EXPECT_THAT(cell["reason"].asString(), HasSubstr(words));
        EXPECT_THAT(cell["reason"].asString(), HasSubstr(", frame 1 of the timing replay"));
    }
}

TEST_F(StoreCommand, damage_that_the_harness_meets_ends_the_cells_over_that_terrain_only) {
    synth("a.tiles");
    synth("b.tiles");
    std::string bytes = bytes_of(file("a.tiles"));
    bytes[terrain::StoreLayout(300, 200, {}).offset({0, 3, 2}) + 5] ^= 16;
    write_bytes(file("a.tiles"), bytes);
    const fs::path damaged = scenario("a.tiles");
    fs::copy_file(damaged, folder_.path() / "damaged.toml");
    const fs::path out = folder_.path() / "out";
    const Finished finished =
        run_lodbench({"run", (folder_.path() / "damaged.toml").string(),
                      scenario("b.tiles").string(), "--out", out.string(), "--method",
                      "reads-tiles", "--plugin-dir", broken_plugin_folder("reads_tiles")},
                     folder_.path());
    EXPECT_EQ(finished.status, 3) << finished.output;
    const std::vector<Json::Value> cells = cells_of(out);
    ASSERT_EQ(cells.size(), 2U);
    for (const Json::Value& cell : cells) {
        if (cell["scenario"].asString() == "damaged") {
            EXPECT_EQ(cell["status"].asString(), "failed");
            EXPECT_THAT(cell["reason"].asString(),
                        testing::StartsWith("reading the terrain: " + file("a.tiles") +
                                            ": tile (level 0, row 3, column 2): the checksum is "));
        } else {
            EXPECT_EQ(cell["status"].asString(), "ok") << cell["reason"];
        }
    }
}

TEST_F(StoreCommand, overrides_of_a_scenario_are_refused_with_its_line) {
    synth("a.tiles");
    for (const char* more : {"spacing = 5\n", "vertical_scale = 2\n", "no_data = 0\n"}) {
        const Finished finished =
            run_lodbench({"run", scenario("a.tiles", more).string(), "--out",
                          (folder_.path() / "out").string(), "--method", "template"},
                         folder_.path());
        EXPECT_EQ(finished.status, 2) << finished.output;
        EXPECT_THAT(finished.output, HasSubstr("s.toml:2"));
        EXPECT_THAT(finished.output, HasSubstr("but a tiled store says that itself"));
        fs::remove_all(folder_.path() / "out");
    }
    synth("a.raw", "10");
    const Finished cold = run_lodbench({"run", scenario("a.raw", "cold = true\n").string(), "--out",
                                        (folder_.path() / "out").string()},
                                       folder_.path());
    EXPECT_EQ(cold.status, 2);
    EXPECT_THAT(cold.output,
                HasSubstr("cold is set, but only a tiled store (.tiles) stays on disk"));
}

TEST_F(StoreCommand, flown_out_of_core_skips_the_methods_that_hold_it_whole) {
    synth("a.tiles");
    const auto fly = [&](const char* more, const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"run",      scenario("a.tiles", more).string(),
                                              "--out",    (folder_.path() / "out").string(),
                                              "--method", "strided",
                                              "--method", "template"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_lodbench(arguments, folder_.path());
    };
    const Finished flown = fly("out_of_core = true\n", {"--no-truth"});
    EXPECT_EQ(flown.status, 0) << flown.output;
    std::map<std::string, Json::Value> cells;
    for (const Json::Value& cell : cells_of(folder_.path() / "out")) {
        cells[cell["method"].asString()] = cell;
    }
    ASSERT_EQ(cells.size(), 2U);
    EXPECT_EQ(cells["strided"]["status"].asString(), "ok");
    EXPECT_EQ(cells["template"]["status"].asString(), "skipped");
    EXPECT_EQ(cells["template"]["reason"].asString(),
              "method 'template' holds the whole terrain in memory, and the scenario is out of "
              "core");
}

TEST_F(StoreCommand, flown_out_of_core_measures_what_is_measured_in_memory) {
    synth("a.tiles");
    const auto fly = [&](const char* more, const char* out) {
        const fs::path folder = folder_.path() / out;
        const Finished flown =
            run_lodbench({"run", scenario("a.tiles", more).string(), "--out", folder.string(),
                          "--method", "strided", "--set", "strided.vertices=16"},
                         folder_.path());
        EXPECT_EQ(flown.status, 0) << flown.output;
        return folder;
    };
    const fs::path in_memory = fly("", "in_memory");
    const fs::path on_disk = fly("out_of_core = true\n", "on_disk");
    EXPECT_GT(cells_of(on_disk)[0]["screen_error_px"]["max"].asDouble(), 0);
    EXPECT_EQ(std::distance(fs::directory_iterator(on_disk), {}),
              std::distance(fs::directory_iterator(in_memory), {}));
    expect_equal_truth(in_memory, on_disk);
}

TEST_F(StoreCommand, economy_of_a_flight_out_of_core_is_refused) {
    synth("a.tiles");
    const Finished refused =
        run_lodbench({"economy", scenario("a.tiles", "out_of_core = true\n").string(), "--frame",
                      "1", "--out", (folder_.path() / "out").string()},
                     folder_.path());
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(
        refused.output,
        HasSubstr("s.toml:2: out_of_core is set, but economy triangulates the whole terrain "
                  "in memory; leave out_of_core out where it fits, or economy under "
                  "[measure]"));
}

TEST_F(StoreCommand, of_any_size_is_built_and_checked_within_bounded_memory) {
    if (kAddressSanitizer || kThreadSanitizer) GTEST_SKIP() << "its shadow memory is counted too";
    synth("a.tiles");
    // 4785 x 3185 samples: 61 MB as float32.
    const auto peak_of = [&](const std::vector<std::string>& arguments) {
        std::vector<std::string> all = {"terrain"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const pid_t child = start_lodbench(all, folder_.path() / "log");
        int status = 0;
        rusage usage{};
        wait4(child, &status, 0, &usage);
        EXPECT_EQ(status, 0) << text_of(folder_.path() / "log");
        return usage.ru_maxrss;  // KiB
    };
    const long small = peak_of({"info", file("a.tiles")});
    const long built = peak_of(
        {"upsample", file("a.tiles"), "-o", file("b.tiles"), "--factor", "16", "--step", "0.5"});
    const long checked = peak_of({"verify", file("b.tiles")});
    // 65 rows a level, four lines of the source, two threads' buffers: a few MB, not 61.
    EXPECT_LT(built - small, 30 << 10);
    EXPECT_LT(checked - small, 30 << 10);
}

}  // namespace
}  // namespace lodbench::test
