// lodbench validate: puts the methods of a plugin to the conformance suite.

#include <fmt/format.h>
#include <json/json.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "api/error.h"
#include "cli/commands.h"
#include "conformance/suite.h"

namespace lodbench::cli {

namespace {

struct ValidateOptions {
    std::string plugin, method, device;
    std::vector<std::string> tests, settings;
    std::uint64_t seed = 1;
    double time_factor = 1;
    bool json = false;
    bool list = false;
};

constexpr int kPromiseBroken = 1;
constexpr int kNothingJudged = 4;

void list_checks() {
    for (const conformance::Check& check : conformance::all_checks()) {
        fmt::print("{:<28} {}\n", check.name, check.promise);
    }
}

std::vector<conformance::Check> chosen_checks(const ValidateOptions& options) {
    if (options.tests.empty()) {
        const auto all = conformance::all_checks();
        return {all.begin(), all.end()};
    }
    std::vector<conformance::Check> checks;
    for (const std::string& name : options.tests) checks.push_back(conformance::find_check(name));
    return checks;
}

std::vector<run::MethodInfo> chosen_methods(const ValidateOptions& options,
                                            const run::PluginListing& listing) {
    if (options.method.empty()) return listing.methods;
    std::string known;
    for (const run::MethodInfo& method : listing.methods) {
        if (method.id == options.method) return {method};
        known += (known.empty() ? "" : ", ") + method.id;
    }
    throw InputError(fmt::format("--method {}: plugin {} holds {}", options.method, options.plugin, known));
}

std::vector<std::pair<std::string, std::string>> parse_settings(const ValidateOptions& options) {
    std::vector<std::pair<std::string, std::string>> settings;
    for (const std::string& text : options.settings) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw InputError(fmt::format("--set {}: expected PARAM=VALUE", text));
        }
        settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return settings;
}

/// What to type to see a failure again.
std::string repeat_command(const ValidateOptions& options, const std::string& method,
                           const std::string& test) {
    std::string text = fmt::format("lodbench validate {} --method {} --test {} --seed {}", options.plugin,
                                   method, test, options.seed);
    for (const std::string& setting : options.settings) text += " --set " + setting;
    return text;
}

void print_line(const ValidateOptions& options, const std::string& method,
                const conformance::CheckReport& report) {
    const std::string verdict = conformance::name_of(report.verdict);
    if (options.json) {
        Json::Value line;
        line["method"] = method;
        line["test"] = report.check;
        line["verdict"] = verdict;
        line["reason"] = report.reason;
        line["seconds"] = report.seconds;
        line["seed"] = Json::UInt64(options.seed);
        Json::StreamWriterBuilder writer;
        writer["indentation"] = "";
        fmt::print("{}\n", Json::writeString(writer, line));
    } else {
        fmt::print("{:<8} {} {} ({:.1f} s){}{}\n", verdict, method, report.check, report.seconds,
                   report.reason.empty() ? "" : ": ", report.reason);
    }
    std::fflush(stdout);
}

int run_validate(const ValidateOptions& options) {
    if (options.list) {
        list_checks();
        return 0;
    }
    if (options.plugin.empty()) {
        throw InputError("no plugin was named; expected `lodbench validate PLUGIN.so` (or --list)");
    }
    std::error_code error;
    const std::filesystem::path plugin = std::filesystem::canonical(options.plugin, error);
    if (error) throw InputError(fmt::format("{}: {}", options.plugin, error.message()));
    const std::vector<conformance::Check> checks = chosen_checks(options);
    const auto settings = parse_settings(options);
    const run::PluginListing listing = run::list_plugin(plugin);
    if (!listing.refusal.empty()) {
        // A plugin that cannot be listed has broken the first promise of all.
        conformance::CheckReport report;
        report.check = "loads";
        report.reason = listing.refusal;
        print_line(options, options.method.empty() ? plugin.stem().string() : options.method, report);
        return kPromiseBroken;
    }
    int passed = 0, failed = 0, skipped = 0;
    for (const run::MethodInfo& method : chosen_methods(options, listing)) {
        static_cast<void>(run::make_params(method, settings, "--set"));
        for (const conformance::Check& check : checks) {
            const conformance::Subject subject{.method = method,
                                               .settings = settings,
                                               .device = options.device,
                                               .seed = options.seed};
            const conformance::CheckReport report =
                conformance::run_check(check, subject, options.time_factor);
            passed += report.verdict == conformance::Verdict::passed;
            failed += report.verdict == conformance::Verdict::failed;
            skipped += report.verdict == conformance::Verdict::skipped;
            print_line(options, method.id, report);
            if (report.verdict == conformance::Verdict::failed && !options.json) {
                fmt::print("         again: {}\n", repeat_command(options, method.id, check.name));
            }
        }
    }
    if (!options.json) {
        fmt::print("{} passed, {} failed, {} skipped, seed {}\n", passed, failed, skipped, options.seed);
    }
    if (failed > 0) return kPromiseBroken;
    return passed > 0 ? 0 : kNothingJudged;
}

}  // namespace

void add_validate(CLI::App& app, int& status) {
    const auto options = std::make_shared<ValidateOptions>();
    CLI::App* command =
        app.add_subcommand("validate", "Put a plugin's methods to the promises that every method makes");
    command->add_option("PLUGIN", options->plugin, "the plugin's file");
    command->add_option("--method", options->method, "only this method of the plugin");
    command->add_option("--test", options->tests, "only this test; may be repeated");
    command->add_option("--set", options->settings, "PARAM=VALUE for all tests; may be repeated");
    command->add_option("--seed", options->seed, "random cameras and frame numbers come from it; 1");
    command->add_option("--device", options->device, "GL device, by number or part of its name");
    command->add_option("--time-factor", options->time_factor, "stretches each test's time limit; 1")
        ->check(CLI::PositiveNumber);
    command->add_flag("--json", options->json, "print one JSON object a line");
    command->add_flag("--list", options->list, "list the tests and what each promises");
    command->callback([options, &status] { status = run_validate(*options); });
}

}  // namespace lodbench::cli
