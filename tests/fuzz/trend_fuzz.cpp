// A libFuzzer target (clang, -DLODBENCH_FUZZ=ON): trend_fuzz [--seeds FOLDER | libFuzzer's own
// arguments]. Any bytes as the database of a history: refused in plain words that name the file, or
// shown as page, Markdown and JSON.

#include <unistd.h>

#include "api/error.h"
#include "fuzz/refusal.h"
#include "fuzz/seeds.h"
#include "report/html/trend_page.h"
#include "report/trend_rows.h"
#include "results/json.h"
#include "trend/fake_history.h"
#include "trend/trends.h"

namespace lodbench::test {
namespace {

namespace fs = std::filesystem;

fs::path scratch_file() {
    return fs::temp_directory_path() / ("trend_fuzz_" + std::to_string(getpid()) + ".sqlite");
}

void use_as_history(std::string_view input) {
    const fs::path file = scratch_file();
    fs::remove(file.string() + "-journal");
    std::ofstream(file, std::ios::binary | std::ios::trunc) << input;
    try {
        const trend::Trends trends =
            trend::find_trends(trend::Database::for_reading(file).read(), {});
        (void)report::html::trend_page(trends, "history");
        (void)report::trend_text(trends);
        (void)results::to_text(to_json(trends));
    } catch (const InputError& error) {
        // Names of tables come from the file, and are made plain where they are printed.
        if (!std::string_view(error.what()).starts_with(file.string() + ":")) {
            finding("the message does not begin with the file: " + std::string(error.what()));
        }
    } catch (const EnvironmentError& error) {
        if (std::string_view(error.what()).find(file.string()) == std::string_view::npos) {
            finding("the message does not name the file: " + std::string(error.what()));
        }
    }
}

std::vector<std::string> seeds() {
    std::vector<std::string> result;
    for (const int runs : {1, 14}) {
        const fs::path file = scratch_file();
        fs::remove(file);
        trend::Database database = trend::Database::for_adding(file);
        for (int run = 0; run < runs; ++run) {
            database.add(fake_run(run, {fake_cell("m", run < 7 ? 1 : 2, R"({"triangles":5})"),
                                        fake_cell("n", 3, R"({"triangles":6.5,"hash":"a"})")}));
        }
        std::ifstream stream(file, std::ios::binary);
        result.emplace_back(std::istreambuf_iterator<char>(stream),
                            std::istreambuf_iterator<char>());
    }
    return result;
}

}  // namespace
}  // namespace lodbench::test

LODBENCH_FUZZ_TARGET(lodbench::test::use_as_history, lodbench::test::seeds)
