// `lodbench sweep` and `lodbench match` as a person types them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <sstream>

#include "support/frames_csv.h"
#include "support/run_lodbench.h"

namespace lodbench::test {
namespace {

using testing::HasSubstr;
using Arguments = std::vector<std::string>;

class Trade : public testing::Test {
protected:
    fs::path write_scenario() {
        fs::path file = folder_.path() / "small.toml";
        std::ofstream(file) << "name = \"small\"\n[terrain]\n"
                            << terrain_
                            << "[viewport]\nwidth = 96\nheight = 72\n"
                               "[flight]\nkind = \"line\"\nwarmup_frames = 1\n"
                            << frames_
                            << "start = [640, 100, 400]\nend = [640, 600, 400]\npitch = -30\n"
                               "[measure]\nshots = [0]\n"
                            << fmt::format("every = {}\n", every_) << measure_
                            << "[run]\nrepetitions = 1\n";
        return file;
    }
    Finished lodbench(const std::string& command, const Arguments& more) {
        Arguments arguments = {command, write_scenario().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_lodbench(arguments, folder_.path(), [this] {
            dup2(open((folder_.path() / "errors").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
        });
    }
    [[nodiscard]] std::string errors() const { return text_of(folder_.path() / "errors"); }
    [[nodiscard]] std::string out(const std::string& name = "out") const {
        return (folder_.path() / name).string();
    }
    Json::Value json(const Finished& finished) {
        EXPECT_EQ(finished.status, 0) << errors();
        return results::parse_json(finished.output, "standard output");
    }

    ScratchFolder folder_;
    std::string terrain_ = "synthetic = \"ridged\"\nrows = 129\ncolumns = 129\nspacing = 10\n";
    std::string frames_ = "frames = 4\n";
    int every_ = 2;
    std::string measure_;  ///< more of that table
};

TEST_F(Trade, sweep_flies_each_knob_around_its_default_and_marks_the_front) {
    const Json::Value swept =
        json(lodbench("sweep", {"--method", "refined", "--method", "every-sample", "--points", "3",
                                "--json", "--out", out()}));
    ASSERT_EQ(swept["cells"].size(), 4U);
    ASSERT_EQ(swept["trade"].size(), 4U);
    EXPECT_EQ(swept["trade"][0]["method"], "every-sample");
    EXPECT_TRUE(swept["trade"][0]["knob"].isNull());
    EXPECT_TRUE(swept["trade"][0]["on_front"].asBool()) << "no other is as exact";
    double error = -1;
    for (const Json::ArrayIndex i : {1U, 2U, 3U}) {
        EXPECT_EQ(swept["trade"][i]["knob"].asDouble(), 0.25 * std::pow(2.0, i));
        EXPECT_GT(swept["trade"][i]["pixel_error_px"].asDouble(), error);
        error = swept["trade"][i]["pixel_error_px"].asDouble();
    }
    EXPECT_THAT(text_of(fs::path(out()) / "trade.md"), HasSubstr("| refined tau=0.5 |"));
}

TEST_F(Trade, values_of_the_user_and_of_the_scenario_go_before_those_around_the_default) {
    const Json::Value swept =
        json(lodbench("sweep", {"--method", "refined", "--method", "strided", "--method",
                                "every-sample", "--set", "strided.vertices=16", "--knob-values",
                                "refined=3,9", "--points", "1", "--json", "--out", out()}));
    std::string labels;
    for (const Json::Value& row : swept["trade"]) labels += row["label"].asString() + ";";
    EXPECT_EQ(labels, "every-sample;refined tau=3;refined tau=9;strided;");
}

TEST_F(Trade, wrong_options_are_refused_before_anything_flies) {
    const struct {
        const char* command;
        Arguments arguments;
        const char* words;
    } wrong[] = {
        {"sweep", {"--knob-values", "refined"}, "expected METHOD=VALUE[,VALUE...]"},
        {"sweep", {"--knob-values", "moon=1"}, "method 'moon' is not flown in this sweep"},
        {"sweep",
         {"--method", "every-sample", "--knob-values", "every-sample=1"},
         "has no quality knob"},
        {"sweep",
         {"--method", "strided", "--set", "strided.vertices=9", "--knob-values", "strided=8"},
         "strided.vertices is set elsewhere too"},
        {"sweep", {"--metric", "mean"}, "expected p999, max or rms"},
        {"sweep", {"--reference", "3"}, "expected PX,MS"},
        {"sweep", {"--reference", "3,-1"}, "expected a positive number"},
        {"match", {}, "0 targets are named"},
        {"match", {"--error", "1px", "--triangles", "5"}, "2 targets are named"},
        {"match", {"--error", "1m"}, "as 1 or 1px"},
        {"match", {"--error", "0"}, "expected a positive number"},
        {"match", {"--frame-ms", "inf"}, "expected a positive number"},
        {"match",
         {"--error", "1", "--method", "refined", "--set", "refined.tau=1"},
         "it is what is to be found"},
        {"match",
         {"--error", "1", "--method", "strided", "--set", "strided.uncovered=0,0.1"},
         "several settings"},
    };
    for (const auto& test : wrong) {
        Arguments arguments = test.arguments;
        arguments.insert(arguments.end(), {"--out", out()});
        EXPECT_EQ(lodbench(test.command, arguments).status, 2) << test.words;
        EXPECT_THAT(errors(), HasSubstr(test.words));
        EXPECT_FALSE(fs::exists(fs::path(out()) / "run.json"));
    }
}

TEST_F(Trade, match_finds_the_knob_and_flies_it_whatever_the_seed) {
    std::vector<double> found;
    for (const char* seed : {"1", "77"}) {
        const Json::Value matched =
            json(lodbench("match", {"--error", "2px", "--method", "refined", "--method",
                                    "every-sample", "--seed", seed, "--json", "--out", out(seed)}));
        ASSERT_EQ(matched["match"]["methods"].size(), 2U);
        const Json::Value& method = matched["match"]["methods"][1];
        EXPECT_EQ(method["method"], "refined");
        EXPECT_EQ(method["outcome"], "met");
        EXPECT_NEAR(method["achieved"].asDouble(), 2.0, 0.1);
        found.push_back(method["knob_value"].asDouble());
        // What was flown in the end is what was found, and it measures the same.
        for (const Json::Value& row : matched["trade"]) {
            if (row["method"] != "refined") continue;
            EXPECT_EQ(row["knob"].asDouble(), found.back());
            EXPECT_NEAR(row["pixel_error_px"].asDouble(), 2.0, 0.1);
        }
        EXPECT_EQ(results::parse_sealed(text_of(fs::path(out(seed)) / "match.json"), "match.json"),
                  matched["match"]);
        EXPECT_THAT(text_of(fs::path(out(seed)) / "match.md"), HasSubstr("| refined "));
    }
    EXPECT_EQ(found[0], found[1]) << "the truth does not depend on the seed";
}

TEST_F(Trade, match_flies_an_asynchronous_method_three_times_where_it_meets_the_target) {
    const Json::Value swept = json(lodbench(
        "sweep", {"--method", "strided", "--method", "refined", "--knob-values", "strided=16",
                  "--knob-values", "refined=4", "--json", "--out", out("sweep")}));
    for (const Json::Value& row : swept["trade"]) {
        // Reached by steps of four from the default.
        const std::string method = row["method"].asString();
        const Json::Value found =
            json(lodbench("match", {"--method", method, "--error",
                                    fmt::format("{}", row["pixel_error_px"].asDouble()),
                                    "--tolerance", "10", "--json", "--out", out(method)}))["match"];
        const Json::Value& entry = found["methods"][0];
        ASSERT_EQ(entry["outcome"], "met") << method;
        const auto flights =
            std::distance(fs::directory_iterator(fs::path(out(method)) / "search"), {});
        EXPECT_EQ(flights, entry["probes"].size() + (method == "strided" ? 2 : 0)) << method;
    }
}

TEST_F(Trade, match_says_what_cannot_be_reached_and_the_nearest_there_is) {
    const Json::Value matched = json(lodbench(
        "match", {"--triangles", "100000000", "--method", "refined", "--json", "--out", out()}));
    const Json::Value& method = matched["match"]["methods"][0];
    EXPECT_EQ(method["outcome"], "unreachable");
    EXPECT_GT(method["achieved"].asDouble(), 1000);
    EXPECT_LT(method["achieved"].asDouble(), 1e6);
    EXPECT_LE(method["knob_value"].asDouble(), 0.02);
    EXPECT_EQ(lodbench("match", {"--error", "1", "--out", out()}).status, 2);
    EXPECT_THAT(errors(), HasSubstr("choose another with --out"));
}

TEST_F(Trade, match_explains_the_outcomes_that_occur_and_gives_no_hypervolume) {
    const auto text = [&](const std::string& name, const Arguments& more) {
        Arguments arguments = {"--method", "refined", "--out", out(name)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished finished = lodbench("match", arguments);
        EXPECT_EQ(finished.status, 0) << errors();
        EXPECT_THAT(finished.output, testing::Not(HasSubstr("ypervolume")));
        EXPECT_THAT(finished.output, HasSubstr("report    lodbench report " + out(name) + "\n"));
        return finished.output;
    };
    const std::string unreachable = "- unreachable: all that was measured lies on one side";
    const std::string between = "- between: values of the knob lie on both sides of the target";
    const std::string met = text("met", {"--error", "2px"});
    EXPECT_THAT(met, testing::Not(testing::AnyOf(HasSubstr(unreachable), HasSubstr(between))));
    EXPECT_THAT(text("far", {"--triangles", "100000000", "--probes", "3"}), HasSubstr(unreachable));
    EXPECT_THAT(text("jump", {"--error", "2px", "--tolerance", "0.01", "--probes", "3"}),
                HasSubstr(between));
}

/// The row of the search's table, by its columns.
std::map<std::string, std::string> search_row(const std::string& text, const std::string& method) {
    const auto fields = [](const std::string& line) {
        std::vector<std::string> found;
        std::istringstream stream(line);
        for (std::string field; std::getline(stream, field, '|');) {
            const std::size_t begin = field.find_first_not_of(' ');
            if (begin == field.npos) continue;
            found.push_back(field.substr(begin, field.find_last_not_of(' ') - begin + 1));
        }
        return found;
    };
    std::istringstream stream(text);
    std::vector<std::string> names;
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("| method ") && names.empty()) names = fields(line);
        if (names.empty() || !line.starts_with("| " + method + " ")) continue;
        std::map<std::string, std::string> row;
        const auto values = fields(line);
        for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) {
            row[names[i]] = values[i];
        }
        return row;
    }
    ADD_FAILURE() << "no row of " << method << " in\n" << text;
    return {};
}

/// Of the frames that have a figure in the column.
std::vector<double> column_of(const fs::path& out, const std::string& column) {
    std::vector<double> values;
    for (const auto& entry : fs::directory_iterator(out / "frames")) {
        for (const FrameTexts& row : read_frames_csv(entry.path())) {
            if (!row.at(column).empty()) values.push_back(std::stod(row.at(column)));
        }
    }
    return values;
}

TEST_F(Trade, what_match_prints_is_what_its_frames_give) {
    // Frame 1 is measured for the economy alone, and is in no figure; frame 2 by `every` too.
    measure_ = "economy = [1, 2]\n";
    const auto figures_of = [&](const std::string& name, const Arguments& target) {
        Arguments arguments = {"--method", "refined", "--out", out(name), "--probes", "5"};
        arguments.insert(arguments.end(), target.begin(), target.end());
        const Finished finished = lodbench("match", arguments);
        EXPECT_EQ(finished.status, 0) << errors();
        EXPECT_THAT(text_of(fs::path(out(name)) / "match.md"), HasSubstr(" flown |"));
        return search_row(finished.output, "refined");
    };
    const auto mean = [](const std::vector<double>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
    };
    const auto six_digits = [](double value) { return fmt::format("{:.6g}", value); };

    const auto greatest = figures_of("max", {"--error", "3", "--metric", "max"});
    const std::vector<double> errors_px = column_of(out("max"), "pixel_max_px");
    EXPECT_EQ(errors_px.size(), 2U) << "the frames that `every` names";
    EXPECT_EQ(greatest.at("flown"), six_digits(*std::ranges::max_element(errors_px)));
    EXPECT_EQ(greatest.at("achieved"), greatest.at("flown"));
    const Json::Value economy = cells_of(out("max")).at(0)["economy"];
    ASSERT_EQ(economy.size(), 1U);
    EXPECT_EQ(economy[0]["frame"].asInt(), 2);

    const auto triangles = figures_of("triangles", {"--triangles", "2000"});
    EXPECT_EQ(triangles.at("flown"), six_digits(mean(column_of(out("triangles"), "triangles"))));
    EXPECT_EQ(triangles.at("achieved"), triangles.at("flown"));

    // Times differ from flight to flight: the final flight's are those of its frames.
    const auto times = figures_of("times", {"--frame-ms", "2"});
    EXPECT_EQ(times.at("flown"), six_digits(mean(column_of(out("times"), "wall_ms"))));
}

TEST_F(Trade, what_match_prints_of_a_percentile_is_that_of_its_one_measured_frame) {
    // Over several frames all their pixels count together, and lie between those of each frame.
    for (const auto& [name, every] : {std::pair("one", 4), {"two", 2}}) {
        every_ = every;
        const Finished finished =
            lodbench("match", {"--method", "refined", "--error", "2", "--out", out(name)});
        ASSERT_EQ(finished.status, 0) << errors();
        const auto row = search_row(finished.output, "refined");
        EXPECT_EQ(row.at("achieved"), row.at("flown"));
        EXPECT_EQ(row.at("outcome"), "met");
        const std::vector<double> frames = column_of(out(name), "pixel_p999_px");
        ASSERT_EQ(frames.size(), std::size_t(4 / every));
        if (every == 4) {
            EXPECT_EQ(row.at("flown"), fmt::format("{:.6g}", frames[0]));
        }
        const double flown = std::stod(row.at("flown"));
        EXPECT_GE(flown, std::ranges::min(frames) * (1 - 1e-5));
        EXPECT_LE(flown, std::ranges::max(frames) * (1 + 1e-5));
    }
}

TEST_F(Trade, match_says_where_its_search_stands_and_what_may_be_left) {
    const Finished finished =
        lodbench("match", {"--method", "refined", "--method", "strided", "--probes", "3",
                           "--triangles", "2000", "--out", out()});
    ASSERT_EQ(finished.status, 0) << errors();
    const std::string told = errors();
    EXPECT_THAT(told, HasSubstr("[1/2] refined: probe 1 of at most 3: tau = 1 gives "));
    EXPECT_THAT(told, HasSubstr("[2/2] strided: probe 1 of at most 3: vertices = "));
    const std::string line = told.substr(told.find("[1/2] refined: probe 1"));
    EXPECT_THAT(line.substr(0, line.find('\n')),
                testing::ContainsRegex(", at most [0-9]+:[0-9][0-9] of searching left$"));
}

TEST_F(Trade, match_redraws_a_line_on_a_terminal_while_a_probe_flies) {
    // `script` gives the command a terminal. Long flights, so that there is something to see.
    if (std::system("command -v script >/dev/null") != 0) GTEST_SKIP() << "no script(1)";
    frames_ = "frames = 400\n";
    write_scenario();
    const std::string command = fmt::format(
        "cd '{}' && script -qec '{} match small.toml --method every-sample --method refined "
        "--probes "
        "2 --triangles 2000 --out terminal' shown >/dev/null 2>&1 </dev/null",
        folder_.path().string(), LODBENCH_BINARY);
    ASSERT_EQ(std::system(command.c_str()), 0) << text_of(folder_.path() / "shown");
    EXPECT_THAT(text_of(folder_.path() / "shown"),
                testing::ContainsRegex("\r.\\[K\\[1/1\\] refined: probe [12] of at most 2: "
                                       "[0-9]+ %, at most [0-9]+:[0-9][0-9] of searching left"));
}

TEST_F(Trade, sweep_names_the_report_but_not_in_its_json) {
    const Arguments arguments = {"--method", "refined", "--points", "1", "--out", out("a b")};
    const Finished plain = lodbench("sweep", arguments);
    EXPECT_EQ(plain.status, 0) << errors();
    EXPECT_THAT(plain.output, HasSubstr("report    lodbench report '" + out("a b") + "'\n"));
    EXPECT_THAT(plain.output, HasSubstr("Hypervolume of p999"));
    Arguments as_json = arguments;
    as_json.insert(as_json.end(), {"--json", "--resume"});
    EXPECT_TRUE(json(lodbench("sweep", as_json))["trade"].isArray());
}

TEST_F(Trade, economy_compares_a_frame_with_what_would_do_at_the_same_error) {
    const Json::Value flown =
        json(lodbench("economy", {"--frame", "1", "--frame", "3", "--method", "refined", "--method",
                                  "every-sample", "--json", "--out", out()}));
    ASSERT_EQ(flown["cells"].size(), 2U);
    for (const Json::Value& cell : flown["cells"]) {
        ASSERT_EQ(cell["economy"].size(), 2U) << cell["method"];
        // Frames 0 and 2 by `every`, 1 and 3 because they are named.
        EXPECT_EQ(cell["truth_frames"].asInt(), 4);
        for (const Json::ArrayIndex i : {0U, 1U}) {
            const Json::Value& frame = cell["economy"][i];
            EXPECT_EQ(frame["frame"].asInt(), i == 0 ? 1 : 3);
            for (const char* bound : {"max", "p999"}) {
                const Json::Value& fewest = frame[bound];
                EXPECT_LE(fewest["greedy_px"].asDouble(), fewest["target_px"].asDouble() + 2e-3);
                EXPECT_LE(fewest["minimal_triangles"].asUInt64(),
                          frame["full_triangles"].asUInt64());
                EXPECT_GE(frame["triangles"].asUInt64(), fewest["minimal_triangles"].asUInt64());
                EXPECT_NEAR(fewest["ratio"].asDouble() * fewest["minimal_triangles"].asDouble(),
                            frame["triangles"].asDouble(), 1e-3);
            }
        }
        if (cell["method"] == "every-sample") {
            EXPECT_EQ(cell["economy"][0]["triangles"].asUInt64(), 2U * 128 * 128);
        }
    }
    EXPECT_THAT(text_of(fs::path(out()) / "economy.md"), HasSubstr("| refined "));
    EXPECT_EQ(lodbench("economy", {"--frame", "4", "--out", out("other")}).status, 2);
    EXPECT_THAT(errors(),
                HasSubstr("--frame 4: [measure] economy = 4: write whole numbers from 0 to 3"));
}

TEST_F(Trade, what_needs_the_truth_measures_it_whatever_the_scenario_says) {
    measure_ = "truth = false\n";
    for (const auto& [command, more] :
         {std::pair<std::string, Arguments>{"sweep", {"--points", "1"}},
          {"economy", {"--frame", "1"}},
          {"match", {"--error", "1", "--probes", "2"}}}) {
        Arguments arguments = {"--method", "refined", "--json", "--out", out(command)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Json::Value cell = json(lodbench(command, arguments))["cells"][0];
        EXPECT_TRUE(cell["pixel_error_px"]["p999"].isNumeric()) << command;
    }
    measure_ = "pixels_only = true\n";
    const Json::Value cell =
        json(lodbench("economy", {"--frame", "1", "--method", "refined", "--json", "--out",
                                  out("samples")}))["cells"][0];
    EXPECT_EQ(cell["status"], "ok") << cell["reason"];
    EXPECT_EQ(cell["economy"].size(), 1U);
}

TEST_F(Trade, out_of_core_an_error_is_matched_and_economy_refused) {
    const std::string store = (folder_.path() / "a.tiles").string();
    ASSERT_EQ(run_lodbench({"terrain", "synth", "ridged", "--rows", "129", "--columns", "129",
                            "--spacing", "10", "-o", store},
                           folder_.path())
                  .status,
              0);
    terrain_ = "file = \"" + store + "\"\nout_of_core = true\n";
    measure_ = "truth = false\n";
    const auto match = [&](const Arguments& target) {
        Arguments arguments = {"--method", "strided", "--probes", "2", "--out", out("match")};
        arguments.insert(arguments.end(), target.begin(), target.end());
        return lodbench("match", arguments).status;
    };
    EXPECT_EQ(match({"--error", "1"}), 0) << errors();
    EXPECT_GT(cells_of(out("match"))[0]["pixel_error_px"]["count"].asUInt64(), 0U);
    const Arguments economy = {"--frame", "1", "--method", "strided", "--out", out("economy")};
    EXPECT_EQ(lodbench("economy", economy).status, 2);
    EXPECT_THAT(errors(), HasSubstr("small.toml:3: out_of_core is set, but economy triangulates "
                                    "the whole terrain in memory"));
    EXPECT_FALSE(fs::exists(out("economy")));
}

}  // namespace
}  // namespace lodbench::test
