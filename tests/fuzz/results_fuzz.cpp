// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): results_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. Any bytes as the files of a results folder: refused as InputError in plain words that
// begin with a file of it, or shown as tables and as a page that holds no raw control character.

#include <unistd.h>

#include <array>

#include "api/error.h"
#include "fuzz/refusal.h"
#include "fuzz/seeds.h"
#include "report/equal_error.h"
#include "report/html/report.h"
#include "report/table.h"

namespace lodbench::test {
namespace {

namespace fs = std::filesystem;

// An input is these files one after the other, each ended by a byte that no text holds. Frames and
// flight are those of the cells `a` and `b` and of the scenario `s`.
constexpr std::array kFiles = {"run.json", "cells.jsonl", "frames/a.csv", "flights/s.json",
                               "match.json"};
constexpr char kEnd = '\x1e';

/// Stays as long as the process.
const fs::path& folder() {
    static const fs::path path = [] {
        const auto made = fs::temp_directory_path() / ("results_fuzz_" + std::to_string(getpid()));
        fs::create_directories(made / "frames");
        fs::create_directories(made / "flights");
        fs::create_directories(made / "shots");
        return made;
    }();
    return path;
}

void write_files(std::string_view input) {
    for (const char* name : kFiles) {
        const std::size_t end = input.find(kEnd);
        const std::string_view text = input.substr(0, end);
        const fs::path file = folder() / name;
        fs::remove(file);
        if (!text.empty()) std::ofstream(file, std::ios::binary) << text;
        if (end == input.npos) {
            input = {};
        } else {
            input.remove_prefix(end + 1);
        }
    }
    std::error_code absent;
    fs::copy_file(folder() / "frames/a.csv", folder() / "frames/b.csv",
                  fs::copy_options::overwrite_existing, absent);
}

void expect_plain_text(const std::string& text, const char* what) {
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F) {
            finding(std::string("a control character in the ") + what);
        }
    }
}

void show(const results::ResultFolder& results) {
    const auto rows = report::table_rows(results.cells, 1);
    (void)report::text_table(rows);  // made plain where it is printed
    (void)report::markdown_table(rows);
    for (const report::EqualFlight& flight : report::equal_flights(results.run)) {
        (void)report::equal_text(flight, results.cells, report::quality_knobs(results.run));
    }
    const report::html::Report page = report::html::make_report({results});
    expect_plain_text(page.html, "page");
}

void use_as_results(std::string_view input) {
    write_files(input);
    try {
        show(results::read_result_folder(folder()));
    } catch (const InputError& error) {
        const std::string_view message = error.what();
        if (!message.starts_with(folder().string())) {
            finding("the message does not begin with the file: " + std::string(message));
        }
    }
}

// As a run of two methods writes them, of each kind of field one.
constexpr const char* kRun = R"({"schema_version":1,"tool_version":"1","commit":"c","seed":1,
"command_line":"lodbench run","os":"o","cpu":"c","warnings":["w"],
"gl":{"vendor":"v","renderer":"r","version":"4.5","software":true,"timer_verdict":"t"},
"scenarios":[{"name":"s","text":"[flight]","frames":2,"width":64,"height":48,"rate_hz":60}],
"plugins":[{"path":"p","refusal":null,"methods":[{"id":"m","title":"t","citation":"c"}]}],
"cells":[{"id":"a"},{"id":"b"}]})";

std::string cell(const char* id, const char* method, const char* tau) {
    const std::string summary = R"({"mean":3.5,"median":3,"p90":4,"p95":4,"p99":null,"p999":null,)"
                                R"("min":2,"max":5,"low1":null,"low1_time":null,"low01":null})";
    const std::string errors =
        R"({"count":9,"uncovered":0,"max":"inf","p999":0.5,"p99":0.4,"max_covered":2,"rms":0.1,)"
        R"("mean":0.1,"over_tau":0,"worst":{"frame":1,"row":2,"column":3}})";
    std::string text = std::string(R"({"cell":")") + id + R"(","method":")" + method +
                       R"(","scenario":"s","params":{"tau":)" + tau +
                       R"(,"text":"x","on":true},"repetition":0,"seed":1,"status":"ok",)"
                       R"("reason":null,"frames":2,"fps":280.5,"jank_ms":0,"truth_frames":2,)"
                       R"("prepare_s":0.1,"prepare_cpu_s":0.1,"upload_s":0,"gpu_bytes":1048576,)"
                       R"("peak_rss_bytes":9999999,"samples_served":4,"samples_prepared":4,)"
                       R"("tiles_served":1,"terrain_bytes_read":0,"claimed_px":1,)"
                       R"("bound_honesty":"inf","uncovered_samples":0,"wall_triangles":0,)"
                       R"("shots_hash":"00000000000000aa","counters":{"nodes":7},)"
                       R"("warnings":["w"],"modules":[],"crack_pixels":{"total":0,"max":0},)"
                       R"("skirt_pixels":{"total":0,"max":0},"silhouette_px":{"max":1,"mean":0},)"
                       R"("popping_px":{"max":1,"p999":0.5,"over_1px":0},"image":{"psnr_db":"inf",)"
                       R"("ssim":1},"height_rmse_m":{"max":1,"mean":1},"economy":[{"frame":1,)"
                       R"("triangles":9,"full_triangles":20,"p999":null,"max":{"target_px":1,)"
                       R"("minimal_triangles":4,"greedy_triangles":5,"greedy_px":1,"ratio":2.2}}])";
    for (const char* key : {"frame_ms", "select_ms", "submit_ms", "cpu_ms", "triangles",
                            "draw_calls", "uploaded_bytes", "triangles_nondegenerate"}) {
        text += std::string(",\"") + key + "\":" + summary;
    }
    for (const char* key : {"screen_error_px", "visible_error_px", "pixel_error_px"}) {
        text += std::string(",\"") + key + "\":" + errors;
    }
    return text + ",\"gpu_ms\":null,\"pixel_error_realtime_px\":null}\n";
}

constexpr const char* kFrames =
    "frame,wall_ms,triangles,pixel_p999_px,popping_p999_px\n0,3.5,9,0.5,\n1,3.25,9,inf,0.25\n";
constexpr const char* kFlight =
    R"({"schema_version":1,"south_west":[0,0],"north_east":[100,200],"spacing":[10,10],"rows":21,)"
    R"("columns":11,"min_height":0,"max_height":9,"positions":[[1,1,5],[9,19,5]],)"
    R"("directions":[[0,1,0],[1,0,0]],"needed":[{"target_px":1,"tiles":2,"samples":8450,)"
    R"("most_tiles_in_a_frame":1}]})";
constexpr const char* kMatch =
    R"({"schema_version":1,"quantity":"pixel_error_px","metric":"p999","target":1,)"
    R"("tolerance":0.05,"methods":[{"method":"m","knob":"tau","outcome":"met","knob_value":2,)"
    R"("achieved":1,"monotone":true,"failure":null,"probes":[[1,0.5],[2,"inf"],[3,null]]}]})";

std::vector<std::string> seeds() {
    const std::string cells = cell("a", "m", "1") + cell("b", "m", "2");
    const auto joined = [](const std::vector<std::string>& files) {
        std::string input;
        for (const std::string& file : files) input += file + kEnd;
        return input;
    };
    return {joined({kRun, cells, kFrames, kFlight, kMatch}), joined({kRun, cells, kFrames}),
            joined({kRun, cell("a", "m", "1"), kFrames, kFlight}),
            joined({kRun, R"({"cell":"a","method":"n","scenario":"t","params":{},"repetition":1,)"
                          R"("status":"failed","reason":"why"})"
                          "\n"})};
}

}  // namespace
}  // namespace lodbench::test

LODBENCH_FUZZ_TARGET(lodbench::test::use_as_results, lodbench::test::seeds)
