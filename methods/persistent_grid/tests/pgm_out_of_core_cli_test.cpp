// pgm over a tiled store, as a user flies it: what is drawn, what is kept, what memory it takes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using Arguments = std::vector<std::string>;

class OutOfCore : public testing::Test {
protected:
    Finished run(const Arguments& arguments) {
        return run_lodbench(arguments, folder_.path(), [this] {
            // All three are looked into: what an earlier run of the user's left is none of ours.
            setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);
            for (const char* variable : {"HOME", "TMPDIR"}) {
                setenv(variable, folder_.path().c_str(), 1);
            }
        });
    }
    [[nodiscard]] std::string file(const char* name) const { return folder_.path() / name; }
    /// The Puget Sound, `factor` times as fine, in store.tiles.
    void make_store(int factor) {
        const std::string raster =
            LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png";
        Arguments arguments = {"terrain",
                               factor > 1 ? "upsample" : "import",
                               raster,
                               "--spacing",
                               "160",
                               "--vertical-scale",
                               "0.1",
                               "--step",
                               "0.1",
                               "-o",
                               file("store.tiles")};
        if (factor > 1) arguments.insert(arguments.end(), {"--factor", std::to_string(factor)});
        const Finished made = run(arguments);
        ASSERT_EQ(made.status, 0) << made.output;
    }
    /// `more`: of [terrain].
    std::string flight(const char* name, const char* more, const char* measure, double speed) {
        std::ofstream(file(name)) << fmt::format(
            "[terrain]\nfile = \"store.tiles\"\n{}\n[camera]\nvertical_fov = 45\nnear = 10\n"
            "[viewport]\nwidth = 160\nheight = 120\n[flight]\nkind = \"line\"\n"
            "start = [98000, 82500, 1600]\nheading = 96\npitch = -9\nspeed = {}\nrate_hz = 30\n"
            "frames = 9\nwarmup_frames = 0\n[measure]\n{}\nshots = [0, 4, 8]\n",
            more, speed, measure);
        return file(name);
    }

    ScratchFolder folder_;
};

TEST_F(OutOfCore, shows_what_is_shown_in_core_and_finds_its_pyramid_again) {
    make_store(1);
    const std::string scenario = flight("flight.toml", "", "every = 8", 30000);
    const std::string out = file("out");
    for (const int cached : {0, 1}) {
        const Finished flown = run({"run", scenario, "--method", "pgm", "--repeat", "1", "--out",
                                    out + std::to_string(cached), "--set",
                                    "pgm.storage=whole,windows", "--set", "pgm.grid=200"});
        ASSERT_EQ(flown.status, 0) << flown.output;
        std::map<std::string, Json::Value> cells;
        for (const Json::Value& cell : cells_of(out + std::to_string(cached))) {
            cells[cell["params"]["storage"].asString()] = cell;
        }
        ASSERT_EQ(cells.size(), 2U);
        const Json::Value &whole = cells["whole"], &windows = cells["windows"];
        EXPECT_EQ(windows["shots_hash"], whole["shots_hash"]);
        EXPECT_EQ(windows["pixel_error_px"], whole["pixel_error_px"]);
        EXPECT_EQ(windows["crack_pixels"]["total"].asInt(), 0);
        EXPECT_EQ(windows["counters"]["pyramid_was_cached"].asInt(), cached);
        EXPECT_EQ(windows["counters"]["windows_behind"].asDouble(), 0);
        EXPECT_GT(windows["counters"]["window_texels_written"].asDouble(), 0);
    }
}

// The store's 4097 x 4097 heights alone are 64 MiB as floats, with their pyramid 85.
TEST_F(OutOfCore, takes_no_memory_for_what_it_does_not_see) {
    make_store(4);
    const std::string scenario = flight("flight.toml", "out_of_core = true", "truth = false", 3000);
    const Finished flown =
        run({"run", scenario, "--method", "pgm", "--method", "full-grid", "--repeat", "1", "--out",
             file("out"), "--set", "pgm.storage=windows", "--set", "pgm.window=256"});
    // full-grid holds the whole terrain: it is passed over.
    std::map<std::string, Json::Value> cells;
    for (const Json::Value& cell : cells_of(file("out"))) cells[cell["method"].asString()] = cell;
    EXPECT_EQ(cells["full-grid"]["status"], "skipped") << flown.output;
    ASSERT_EQ(cells["pgm"]["status"], "ok") << flown.output;
    EXPECT_LT(cells["pgm"]["gpu_bytes"].asDouble(), 16 * (1 << 20));

    const Finished small = run({"run", scenario, "--method", "pgm", "--repeat", "1", "--out",
                                file("out2"), "--set", "pgm.storage=whole"});
    const std::vector<Json::Value> whole = cells_of(file("out2"));
    ASSERT_EQ(whole.size(), 1U);
    ASSERT_EQ(whole[0]["status"], "ok") << small.output;
    EXPECT_LT(cells["pgm"]["peak_rss_bytes"].asDouble() + 80e6,
              whole[0]["peak_rss_bytes"].asDouble());
}

}  // namespace
}  // namespace lodbench::test
