// lodbench report: results folders as one page, and its tables as CSV.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <system_error>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "report/html/figure.h"
#include "report/html/report.h"
#include "report/junit.h"

namespace lodbench::cli {

namespace fs = std::filesystem;

namespace {

struct ReportOptions {
    std::vector<fs::path> folders;
    fs::path out;
    fs::path csv;
    fs::path junit;
    std::string figure;
};

std::vector<results::ResultFolder> read_folders(const std::vector<fs::path>& paths) {
    std::vector<results::ResultFolder> folders;
    std::set<fs::path> known;
    for (const fs::path& path : paths) {
        expect_results_folder(path);
        if (!known.insert(fs::canonical(path)).second) {
            throw InputError(fmt::format("{}: this folder is named twice", path.string()));
        }
        folders.push_back(results::read_result_folder(path));
    }
    return folders;
}

void write_csv(const fs::path& folder, const std::map<std::string, std::string>& tables) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}; choose another with --csv", folder.string(),
                        error.message()));
    }
    for (const auto& [name, csv] : tables) base::write_whole(folder / (name + ".csv"), csv);
}

/// NAME.svg, or as --out says. Throws InputError for another format.
fs::path figure_file(const ReportOptions& options) {
    const fs::path out = options.out.empty() ? fs::path(options.figure + ".svg") : options.out;
    if (out.extension() == ".svg") return out;
    const fs::path svg = fs::path(out).replace_extension(".svg");
    const std::string convert =
        out.extension() == ".pdf"
            ? fmt::format(
                  ", then convert it: rsvg-convert -f pdf -o {} {} (of Debian's "
                  "librsvg2-bin)",
                  out.string(), svg.string())
            : "";
    throw InputError(fmt::format("--out {}: a figure is an SVG; give --out {}{}", out.string(),
                                 svg.string(), convert));
}

void write_figure(const ReportOptions& options) {
    const fs::path out = figure_file(options);
    const report::html::Report page = report::html::make_report(read_folders(options.folders));
    base::write_whole(out, figure_svg(find_plot(page.plots, options.figure)));
    base::print("figure    {}\n", fs::absolute(out).lexically_normal().string());
}

void write_junit(const ReportOptions& options, const std::vector<results::ResultFolder>& folders) {
    if (folders.size() != 1) {
        throw InputError(fmt::format("--junit {}: it is of one results folder, and {} are named",
                                     options.junit.string(), folders.size()));
    }
    base::write_whole(options.junit, report::junit_of(folders.front()));
}

void write(const ReportOptions& options) {
    if (!options.figure.empty()) return write_figure(options);
    const std::vector<results::ResultFolder> folders = read_folders(options.folders);
    if (!options.junit.empty()) write_junit(options, folders);
    const report::html::Report page = report::html::make_report(folders);
    const fs::path out =
        options.out.empty() ? options.folders.front() / "report.html" : options.out;
    if (!options.csv.empty()) write_csv(options.csv, page.csv);
    base::write_whole(out, page.html);
    base::print("report    {}\n", fs::absolute(out).lexically_normal().string());
    if (!options.csv.empty()) {
        base::print("tables    {}\n", fs::absolute(options.csv).lexically_normal().string());
    }
}

}  // namespace

void add_report(CLI::App& app, int& /*status*/) {
    const auto options = std::make_shared<ReportOptions>();
    CLI::App* command =
        app.add_subcommand("report", "Write results folders as one HTML page that opens offline");
    command
        ->add_option("DIR", options->folders,
                     "results folders, as `lodbench run --out` writes them")
        ->required();
    command->add_option("--out,-o", options->out,
                        "the page, or the figure; default report.html in the first folder");
    auto* csv = command->add_option("--csv", options->csv, "folder to write every table to as CSV");
    auto* junit = command->add_option(
        "--junit", options->junit,
        "file to write JUnit XML to as well: a case for each cell of the one folder");
    auto* figure = command->add_option(
        "--figure", options->figure,
        "one plot alone as an SVG, for a paper: its id on the page, as trade-time; "
        "an unknown name lists them; --out names the file, default NAME.svg");
    figure->excludes(csv)->excludes(junit);
    command->callback([options] { write(*options); });
}

}  // namespace lodbench::cli
