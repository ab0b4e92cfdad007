// `lodbench run` as a person types it: what it prints, the files it writes, and that they agree.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using Arguments = std::vector<std::string>;

/// One row of frames/<cell>.csv by column; an empty field is absent.
using FrameRow = std::map<std::string, double>;

class Run : public testing::Test {
protected:
    struct Spoken {
        int status = -1;
        std::string out, err;
    };

    /// A terrain of 129 x 129 samples: 2 x 2 blocks of 64 x 64 cells for every-sample. The camera
    /// looks straight down at all of it first, and leaves it behind in the end.
    fs::path scenario(const std::string& more = "") {
        const fs::path file = folder_.path() / "small.toml";
        std::ofstream(file) << "name = \"small\"\n[terrain]\nsynthetic = \"ridged\"\nrows = 129\n"
                               "columns = 129\nspacing = 10\n[viewport]\nwidth = 48\nheight = 36\n"
                               "[flight]\nkind = \"line\"\nframes = 8\nwarmup_frames = 1\n"
                               "start = [640, 640, 2500]\nend = [4000, 640, 2500]\npitch = -90\n"
                               "[measure]\nevery = 3\nshots = [0]\n[run]\nrepetitions = 1\n"
                            << more;
        return file;
    }
    [[nodiscard]] fs::path out(const std::string& name = "out") const {
        return folder_.path() / name;
    }

    /// Standard output and error apart.
    Spoken run(const fs::path& scenario, Arguments more, const fs::path& out) {
        Arguments arguments = {"run", scenario.string(), "--out", out.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const fs::path err = folder_.path() / "standard-error";
        const Finished finished = run_lodbench(arguments, folder_.path(), [&err] {
            dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
        });
        return {finished.status, finished.output, text_of(err)};
    }

    static std::vector<FrameRow> frames_of(const fs::path& out, const std::string& cell) {
        std::vector<FrameRow> rows;
        for (const FrameTexts& texts : read_frames_csv(out / "frames" / (cell + ".csv"))) {
            FrameRow& row = rows.emplace_back();
            for (const auto& [column, text] : texts) {
                if (!text.empty()) row[column] = std::stod(text);
            }
        }
        return rows;
    }
    static Json::Value run_json(const fs::path& out) {
        return results::parse_json(text_of(out / "run.json"), "run.json");
    }

    ScratchFolder folder_;
};

const Arguments kThree = {"--method", "every-sample", "--method", "refined",
                          "--method", "strided",      "--set",    "strided.vertices=24"};

Arguments operator+(Arguments first, const Arguments& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

TEST_F(Run, table_goes_to_standard_output_and_progress_to_standard_error) {
    const Spoken spoken =
        run(scenario(),
            {"--method", "strided", "--method", "every-sample", "--set", "strided.vertices=24,32"},
            out());
    ASSERT_EQ(spoken.status, 0) << spoken.err;
    // One row for each method and setting, whatever order they were named and flown in.
    std::vector<std::size_t> at;
    for (const char* text : {"small\n", "  method ", "fps (range)", "median ms", "triangles",
                             "GPU MiB", "\n  every-sample ", "\n  strided vertices=24 ",
                             "\n  strided vertices=32 ", "\nresults ", "\npictures "}) {
        at.push_back(spoken.out.find(text));
        ASSERT_NE(at.back(), std::string::npos) << text << " in " << spoken.out;
    }
    EXPECT_TRUE(std::ranges::is_sorted(at)) << spoken.out;
    EXPECT_THAT(spoken.out, HasSubstr(out().string()));
    EXPECT_THAT(spoken.err, HasSubstr("[3/3] "));
    EXPECT_EQ(spoken.out.find("[3/3]"), std::string::npos);
    EXPECT_THAT(text_of(out() / "summary.md"), HasSubstr("| strided vertices=24 | "));
}

TEST_F(Run, json_is_one_object_with_the_cells_as_they_are_in_the_file) {
    const Spoken spoken = run(scenario(), kThree + Arguments{"--json"}, out());
    ASSERT_EQ(spoken.status, 0) << spoken.err;
    const Json::Value json = results::parse_json(spoken.out, "standard output");
    EXPECT_EQ(json["out"].asString(), out().string());
    EXPECT_EQ(json["exit_status"].asInt(), 0);
    EXPECT_TRUE(json["error"].isNull());
    EXPECT_TRUE(json["warnings"].isArray());
    const std::vector<Json::Value> cells = cells_of(out());
    ASSERT_EQ(json["cells"].size(), cells.size());
    for (Json::ArrayIndex i = 0; i < json["cells"].size(); ++i)
        EXPECT_EQ(json["cells"][i], cells[i]);
}

TEST_F(Run, options_replace_what_the_scenario_says_and_lists_are_swept) {
    const Spoken spoken =
        run(scenario("[[method]]\nid = \"every-sample\"\n"),
            {"--method", "refined", "--set", "refined.tau=1,4", "--set", "refined.culling=false",
             "--size", "40x30", "--frames", "3", "--repeat", "2", "--seed", "77"},
            out());
    ASSERT_EQ(spoken.status, 0) << spoken.err;
    std::map<double, std::set<int>> repetitions;
    for (const Json::Value& cell : cells_of(out())) {
        EXPECT_EQ(cell["method"].asString(), "refined")
            << "--method leaves out what the scenario names";
        EXPECT_EQ(cell["frames"].asInt(), 3);
        EXPECT_FALSE(cell["params"]["culling"].asBool());
        EXPECT_EQ(cell["claimed_px"].asDouble(), cell["params"]["tau"].asDouble());
        EXPECT_EQ(frames_of(out(), cell["cell"].asString()).size(), 3U);
        repetitions[cell["params"]["tau"].asDouble()].insert(cell["repetition"].asInt());
    }
    EXPECT_EQ(repetitions, (std::map<double, std::set<int>>{{1, {0, 1}}, {4, {0, 1}}}));
    const Json::Value json = run_json(out());
    EXPECT_EQ(json["seed"].asUInt64(), 77U);
    EXPECT_EQ(json["scenarios"][0]["frames"].asInt(), 3);
    EXPECT_EQ(json["scenarios"][0]["width"].asInt(), 40);
    EXPECT_EQ(json["scenarios"][0]["height"].asInt(), 30);
    EXPECT_EQ(json["scenarios"][0]["repetitions"].asInt(), 2);
}

TEST_F(Run, pictures_and_wireframes_are_whole_png_of_the_size_asked_for) {
    const Spoken spoken =
        run(scenario(), kThree + Arguments{"--size", "40x30", "--frames", "2"}, out());
    ASSERT_EQ(spoken.status, 0) << spoken.err;
    std::set<std::string> names;
    std::string check = "/usr/bin/python3 " LODBENCH_SOURCE_DIR "/tests/support/check_png.py 40 30";
    for (const auto& file : fs::directory_iterator(out() / "shots")) {
        names.insert(file.path().filename().string());
        // The worst frame's picture is of several panels and its own size.
        if (file.path().stem().string().ends_with("__worst")) continue;
        check += " '" + file.path().string() + "'";
    }
    EXPECT_EQ(std::system(check.c_str()), 0);
    EXPECT_EQ(
        names,
        (std::set<std::string>{
            "every-sample__small__r0__f00000.png", "every-sample__small__r0__f00000__wireframe.png",
            "every-sample__small__r0__worst.png", "refined__small__r0__f00000.png",
            "refined__small__r0__f00000__wireframe.png", "refined__small__r0__worst.png",
            "strided__vertices=24__small__r0__f00000.png",
            "strided__vertices=24__small__r0__f00000__wireframe.png",
            "strided__vertices=24__small__r0__worst.png"}));
    EXPECT_NE(text_of(out() / "shots" / "every-sample__small__r0__f00000.png"),
              text_of(out() / "shots" / "every-sample__small__r0__f00000__wireframe.png"));
}

TEST_F(Run, cells_have_every_field_and_null_where_nothing_was_measured) {
    ASSERT_EQ(run(scenario(), kThree, out()).status, 0);
    const std::vector<Json::Value> cells = cells_of(out());
    ASSERT_EQ(cells.size(), 3U);
    for (const Json::Value& cell : cells) {
        for (const char* text : {"cell", "method", "scenario", "status", "terrain",
                                 "terrain_checksum", "timer_verdict", "depth_hash"}) {
            EXPECT_TRUE(cell[text].isString() && !cell[text].asString().empty()) << text;
        }
        for (const char* number :
             {"repetition", "frames", "fps", "prepare_s", "gpu_bytes", "peak_rss_bytes"}) {
            EXPECT_TRUE(cell[number].isNumeric()) << number;
        }
        for (const char* time : {"frame_ms", "select_ms", "submit_ms", "gpu_ms", "cpu_ms"}) {
            if (std::string(time) == "gpu_ms" && cell[time].isNull())
                continue;  // no timer to believe
            EXPECT_TRUE(cell[time]["mean"].isNumeric()) << time;
            EXPECT_TRUE(cell[time]["median"].isNumeric()) << time;
            for (const char* part : {"p90", "p95", "p99", "p999", "low1", "low1_time", "low01"}) {
                EXPECT_TRUE(cell[time].isMember(part)) << time << part;
                EXPECT_TRUE(cell[time][part].isNull()) << "8 frames do not support " << part;
            }
        }
        for (const char* count :
             {"triangles", "triangles_nondegenerate", "draw_calls", "uploaded_bytes"}) {
            for (const char* part : {"mean", "min", "max"}) {
                EXPECT_TRUE(cell[count][part].isNumeric()) << count << part;
            }
        }
        EXPECT_TRUE(cell["params"].isObject());
        EXPECT_TRUE(cell["counters"].isObject());
        for (const char* errors : {"screen_error_px", "visible_error_px", "pixel_error_px"}) {
            for (const char* part : {"max", "p999", "p99", "rms", "mean", "over_tau", "worst"}) {
                EXPECT_TRUE(cell[errors].isMember(part)) << errors << part;
            }
            EXPECT_EQ(cell[errors]["over_tau"].isNull(), cell["method"] != "refined") << errors;
        }
        for (const char* object : {"crack_pixels", "skirt_pixels", "silhouette_px", "popping_px",
                                   "height_rmse_m", "image"}) {
            EXPECT_TRUE(cell[object].isObject()) << object;
        }
        EXPECT_TRUE(cell["uncovered_samples"].isNumeric());
        EXPECT_EQ(cell["bound_honesty"].isNull(), cell["method"] != "refined");
        ASSERT_TRUE(cell.isMember("pixel_error_realtime_px"));
        EXPECT_EQ(cell["pixel_error_realtime_px"].isNull(), cell["method"] != "strided")
            << "the one that is asynchronous";
        EXPECT_TRUE(cell.isMember("reason"));
        EXPECT_TRUE(cell["reason"].isNull());
        EXPECT_TRUE(cell.isMember("claimed_px"));
        EXPECT_EQ(cell["claimed_px"].isNull(), cell["method"] != "refined");
    }
}

TEST_F(Run, statistics_of_a_cell_are_those_of_its_frames) {
    constexpr int kFrames = 200;  // as many as P95 needs
    ASSERT_EQ(
        run(scenario(), {"--method", "every-sample", "--frames", std::to_string(kFrames)}, out())
            .status,
        0);
    const Json::Value cell = cells_of(out()).at(0);
    const std::vector<FrameRow> frames = frames_of(out(), cell["cell"].asString());
    ASSERT_EQ(frames.size(), std::size_t(kFrames));
    std::vector<double> wall, triangles;
    std::size_t measured = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(frames[i].at("frame"), double(i));
        wall.push_back(frames[i].at("wall_ms"));
        triangles.push_back(frames[i].at("triangles"));
        measured += frames[i].contains("triangles_nondegenerate");
        EXPECT_EQ(frames[i].contains("triangles_nondegenerate"), i % 3 == 0) << "every = 3";
    }
    EXPECT_EQ(measured, 67U);
    std::ranges::sort(wall);
    const double mean = std::accumulate(wall.begin(), wall.end(), 0.0) / kFrames;
    // The smallest time such that at least p percent of all are not above it.
    const auto nearest_rank = [&](int percent) {
        return wall[std::size_t((kFrames * percent + 99) / 100 - 1)];
    };
    const Json::Value& times = cell["frame_ms"];
    const double rounding = 1e-12 * wall.back();  // written with 15 digits
    EXPECT_NEAR(cell["fps"].asDouble(), 1000 / mean, 1e-12 * 1000 / mean);
    EXPECT_NEAR(times["mean"].asDouble(), mean, rounding);
    EXPECT_NEAR(times["median"].asDouble(), (wall[99] + wall[100]) / 2, rounding);
    EXPECT_NEAR(times["p90"].asDouble(), nearest_rank(90), rounding);
    EXPECT_NEAR(times["p95"].asDouble(), nearest_rank(95), rounding);
    EXPECT_TRUE(times["p99"].isNull()) << "needs 1000 frames";
    EXPECT_NEAR(times["min"].asDouble(), wall.front(), rounding);
    EXPECT_NEAR(times["max"].asDouble(), wall.back(), rounding);
    EXPECT_NEAR(times["low1"].asDouble(), (wall[198] + wall[199]) / 2, rounding);
    EXPECT_EQ(cell["triangles"]["max"].asDouble(), *std::ranges::max_element(triangles));
    EXPECT_EQ(cell["triangles"]["min"].asDouble(), *std::ranges::min_element(triangles));
}

TEST_F(Run, tells_the_first_frame_of_all_and_when_a_cell_began) {
    const std::string cell = "template__small__r0";
    for (const bool warmed : {false, true}) {
        const fs::path folder = out(warmed ? "warmed" : "cold");
        const std::string frames = warmed ? "2" : "0";
        ASSERT_EQ(
            run(scenario(),
                {"--method", "template", "--override", "flight.warmup_frames=" + frames}, folder)
                .status,
            0);
        const Json::Value record = cells_of(folder).at(0);
        const double first = record["first_frame_ms"].asDouble();
        const std::vector<FrameRow> timed = frames_of(folder, cell);
        if (warmed) {
            // It compiles shaders, which takes many times what a frame does that nothing disturbs.
            const auto by_time = [](const FrameRow& row) { return row.at("wall_ms"); };
            EXPECT_GT(first, 2 * by_time(*std::ranges::min_element(timed, {}, by_time)));
        } else {
            EXPECT_NEAR(first, timed.at(0).at("wall_ms"), 1e-12 * first)
                << "written with 15 digits";
        }
        EXPECT_THAT(record["began"].asString(),
                    testing::MatchesRegex("[0-9]+-[0-9]+-[0-9]+T[0-9]+:[0-9]+:[0-9]+\\.[0-9]+Z"));
    }
}

TEST_F(Run, one_seed_gives_the_same_order_counts_and_pictures_twice) {
    const fs::path file = scenario();
    const Arguments seeded = kThree + Arguments{"--seed", "5"};
    ASSERT_EQ(run(file, seeded, out("first")).status, 0);
    ASSERT_EQ(run(file, seeded, out("second")).status, 0);
    const std::vector<Json::Value> first = cells_of(out("first")), second = cells_of(out("second"));
    ASSERT_EQ(first.size(), 3U);
    ASSERT_EQ(second.size(), 3U);
    for (std::size_t i = 0; i < first.size(); ++i) {
        const std::string cell = first[i]["cell"].asString();
        EXPECT_EQ(cell, second[i]["cell"].asString()) << "the order of the cells";
        EXPECT_EQ(first[i]["depth_hash"], second[i]["depth_hash"]) << cell;
        const std::vector<FrameRow> a = frames_of(out("first"), cell),
                                    b = frames_of(out("second"), cell);
        ASSERT_EQ(a.size(), 8U);
        ASSERT_EQ(b.size(), 8U);
        for (std::size_t frame = 0; frame < a.size(); ++frame) {
            for (const char* count : {"triangles", "draw_calls", "uploaded_bytes"}) {
                EXPECT_EQ(a[frame].at(count), b[frame].at(count))
                    << cell << ", frame " << frame << ": " << count;
            }
        }
    }
    ASSERT_EQ(run(file, kThree + Arguments{"--seed", "6", "--frames", "1"}, out("other")).status,
              0);
    const auto order_of = [this](const std::string& name) {
        std::vector<std::string> order;
        for (const Json::Value& cell : cells_of(out(name)))
            order.push_back(cell["cell"].asString());
        return order;
    };
    const std::vector<std::string> order = order_of("first"), other = order_of("other");
    EXPECT_NE(order, other) << "another seed gives another order";
    EXPECT_THAT(order, testing::UnorderedElementsAreArray(other));
}

TEST_F(Run, a_cell_loads_no_module_that_its_scenario_does_not_need) {
    const fs::path file = folder_.path() / "image.toml";
    std::ofstream(file) << "[terrain]\nfile = \"" LODBENCH_SOURCE_DIR
                           "/scenarios/terrain/puget_sound_1025_160m.png\"\n"
                           "[viewport]\nwidth = 48\nheight = 36\n[flight]\nkind = \"line\"\n"
                           "relative = true\nstart = [0.5, 0.5, 9000]\nend = [0.6, 0.5, 9000]\n"
                           "pitch = -90\nframes = 2\n[run]\nrepetitions = 1\n";
    const auto modules = [&](Arguments more, const std::string& name) {
        more.insert(more.end(), {"--method", "template"});
        EXPECT_EQ(run(file, more, out(name)).status, 0);
        return cells_of(out(name)).at(0)["modules"];
    };
    const Json::Value none = Json::arrayValue;
    EXPECT_EQ(modules({"--no-truth"}, "bare"), none);
#ifdef LODBENCH_WITH_WEBP
    Json::Value webp = none;
    webp.append("webp");
    EXPECT_EQ(modules({}, "measured"), webp);
#else
    EXPECT_EQ(modules({}, "measured"), none);
#endif
}

TEST_F(Run, run_json_holds_the_whole_context) {
    const fs::path file = scenario();
    ASSERT_EQ(run(file, {"--method", "refined"}, out()).status, 0);
    const Json::Value json = run_json(out());
    EXPECT_TRUE(json["schema_version"].isNumeric());
    for (const char* text :
         {"tool_version", "compiler", "abi_tag", "os", "kernel", "cpu", "command_line"}) {
        EXPECT_TRUE(json[text].isString() && !json[text].asString().empty()) << text;
    }
    for (const char* member : {"commit", "build_type"})
        EXPECT_TRUE(json.isMember(member)) << member;
    EXPECT_THAT(json["command_line"].asString(), HasSubstr("run " + file.string()));
    EXPECT_GE(json["cores"].asInt(), 1);
    for (const char* text : {"vendor", "renderer", "version", "device", "timer_verdict"}) {
        EXPECT_TRUE(json["gl"][text].isString() && !json["gl"][text].asString().empty()) << text;
    }
    EXPECT_TRUE(json["gl"]["software"].isBool());
    EXPECT_EQ(json["scenarios"][0]["text"].asString(), text_of(file));
    EXPECT_EQ(text_of(out() / "scenarios" / "small.toml"), text_of(file));
    EXPECT_EQ(json["seed"].asUInt64(), 1U);
    EXPECT_TRUE(json["warnings"].isArray());
    EXPECT_GE(json["plugins"].size(), 3U);
    EXPECT_EQ(json["cells"].size(), 1U);
    // Every parameter with its value, the ones left alone too.
    const Json::Value cell = cells_of(out()).at(0);
    for (const char* name : {"tau", "culling"}) {
        EXPECT_TRUE(cell["params"].isMember(name)) << name;
    }
}

TEST_F(Run, a_flight_that_sees_no_terrain_is_told_once_and_stands_in_the_results) {
    // Over the deep sea, as high as the sea's surface.
    const fs::path file = folder_.path() / "deep.toml";
    std::ofstream(file) << "[terrain]\nsynthetic = \"plane\"\nrows = 17\ncolumns = 17\n"
                           "[terrain.shape]\nheight = -8000\n[viewport]\nwidth = 48\nheight = 36\n"
                           "[flight]\nkind = \"orbit\"\nrelative = true\ncentre = [0.5, 0.5]\n"
                           "radius = 300\nturns = 0\nframes = 3\nwarmup_frames = 0\n"
                           "[run]\nrepetitions = 2\n";
    const auto times = [](const std::string& text, const std::string& part) {
        int count = 0;
        for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
        return count;
    };
    const Spoken spoken = run(file, {"--method", "every-sample"}, out());
    ASSERT_EQ(spoken.status, 0) << spoken.err;
    const std::string blind =
        "warning: the flight of 'deep': no terrain is in view in all 3 frames";
    EXPECT_EQ(times(spoken.err, blind), 1) << spoken.err;
    EXPECT_EQ(times(spoken.err, "the camera stands still"), 1) << spoken.err;
    const Json::Value run_json = results::parse_json(text_of(out() / "run.json"), "run.json");
    EXPECT_EQ(times(results::to_text(run_json["warnings"]), "no terrain is in view"), 1);
    const std::vector<Json::Value> cells = cells_of(out());
    ASSERT_EQ(cells.size(), 2U);
    for (const Json::Value& cell : cells) {
        EXPECT_EQ(times(results::to_text(cell["warnings"]), "no terrain is in view"), 1);
    }
    EXPECT_EQ(times(text_of(out() / "summary.md"), "no terrain is in view"), 1);
    // As tools that read line by line look for it.
    EXPECT_THAT(text_of(out() / "run.json"), HasSubstr("\"warnings\" : [\n"));
    const Finished reported = run_lodbench(
        {"report", out().string(), "-o", (folder_.path() / "r.html").string()}, folder_.path());
    ASSERT_EQ(reported.status, 0) << reported.output;
    EXPECT_EQ(
        times(text_of(folder_.path() / "r.html"), "<li>the flight of &#39;deep&#39;: no terrain"),
        1);
}

}  // namespace
}  // namespace lodbench::test
