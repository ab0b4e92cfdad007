// lodbench validate: puts the methods of a plugin to the conformance suite.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/error.h"
#include "base/console.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "conformance/suite.h"
#include "results/json.h"
#include "run/exit_status.h"

namespace lodbench::cli {

namespace {

struct ValidateOptions {
    std::string plugin, method, device;
    std::vector<std::string> tests, settings;
    std::uint64_t seed = 1;
    double time_factor = 1;
    std::optional<double> time_limit_s;
    bool json = false;
    bool list = false;
    bool strict = false;
};

void list_checks() {
    for (const conformance::Check& check : conformance::all_checks()) {
        base::print("{:<28} {}\n", check.name, check.promise);
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
    return {run::find_method({listing}, options.method, "--method in plugin " + options.plugin)};
}

/// What --set says of one method.
run::Settings settings_of(const std::vector<run::Setting>& all, const std::string& method) {
    run::Settings settings;
    for (const run::Setting& setting : all) {
        if (setting.method.empty() || setting.method == method) {
            settings.emplace_back(setting.name, setting.value);
        }
    }
    return settings;
}

std::vector<run::Setting> parse_settings(const ValidateOptions& options,
                                         const std::vector<run::MethodInfo>& methods) {
    std::vector<run::Setting> settings;
    for (const std::string& text : options.settings) {
        settings.push_back(run::parse_setting(text, "[METHOD.]PARAM=VALUE"));
        const std::string& id = settings.back().method;
        if (!id.empty() && std::ranges::find(methods, id, &run::MethodInfo::id) == methods.end()) {
            throw InputError(fmt::format("--set {}: method '{}' is not validated here", text, id));
        }
    }
    return settings;
}

/// What to type to see a failure again.
std::string repeat_command(const ValidateOptions& options, const std::string& method,
                           const run::Settings& settings, const std::string& test) {
    std::string text = fmt::format("lodbench validate {} --method {} --test {} --seed {}",
                                   options.plugin, method, test, options.seed);
    if (options.strict) text += " --strict";
    for (const auto& [name, value] : settings) text += fmt::format(" --set {}={}", name, value);
    return text;
}

double limit_of(const ValidateOptions& options, const conformance::Check& check) {
    return options.time_limit_s.value_or(check.time_limit_s) * options.time_factor;
}

conformance::CheckReport not_run(const conformance::Check& check, const std::string& why) {
    conformance::CheckReport report;
    report.check = check.name;
    report.verdict = conformance::Verdict::skipped;
    report.reason = "not run: " + why;
    return report;
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
        base::print("{}\n", results::to_text(line));
    } else {
        base::print("{:<8} {} {} ({:.1f} s){}{}\n", verdict, method, report.check, report.seconds,
                    report.reason.empty() ? "" : ": ", report.reason);
    }
    std::fflush(stdout);
}

int run_validate(const ValidateOptions& options) {
    if (options.list) {
        list_checks();
        return run::kAllWell;
    }
    if (options.plugin.empty()) {
        throw InputError("no plugin was named; expected `lodbench validate PLUGIN.so` (or --list)");
    }
    std::error_code error;
    const std::filesystem::path plugin = std::filesystem::canonical(options.plugin, error);
    if (error) throw InputError(fmt::format("{}: {}", options.plugin, error.message()));
    const std::vector<conformance::Check> checks = chosen_checks(options);
    const run::PluginListing listing = run::list_plugin(plugin);
    if (!listing.refusal.empty()) {
        // A plugin that cannot be listed has broken the first promise of all.
        conformance::CheckReport report;
        report.check = "loads";
        report.reason = listing.refusal;
        print_line(options, options.method.empty() ? plugin.stem().string() : options.method,
                   report);
        return run::kPromiseBroken;
    }
    int passed = 0, warned = 0, failed = 0, skipped = 0;
    const std::vector<run::MethodInfo> methods = chosen_methods(options, listing);
    const std::vector<run::Setting> all_settings = parse_settings(options, methods);
    for (const run::MethodInfo& method : methods) {
        const run::Settings settings = settings_of(all_settings, method.id);
        static_cast<void>(run::make_params(method, settings, "--set"));
        std::string hung;  // a call that does not come back costs one limit, not one a test
        const conformance::Subject subject{
            .method = method, .settings = settings, .device = options.device, .seed = options.seed};
        for (const conformance::Check& check : checks) {
            conformance::CheckReport report =
                hung.empty() ? conformance::run_check(check, subject, limit_of(options, check))
                             : not_run(check, hung);
            if (!report.hung_in.empty()) {
                hung = fmt::format("{} hung in {}", report.check, report.hung_in);
            }
            if (options.strict && report.verdict == conformance::Verdict::warned) {
                report.verdict = conformance::Verdict::failed;
            }
            warned += report.verdict == conformance::Verdict::warned;
            passed += report.verdict == conformance::Verdict::passed;
            failed += report.verdict == conformance::Verdict::failed;
            skipped += report.verdict == conformance::Verdict::skipped;
            print_line(options, method.id, report);
            if (report.verdict == conformance::Verdict::failed && !options.json) {
                base::print("         again: {}\n",
                            repeat_command(options, method.id, settings, check.name));
            }
        }
    }
    if (!options.json) {
        base::print("{} passed, {} failed, {} skipped, {} warned, seed {}\n", passed, failed,
                    skipped, warned, options.seed);
    }
    if (failed > 0) return run::kPromiseBroken;
    return passed + warned > 0 ? run::kAllWell : run::kNothingMeasured;
}

}  // namespace

void add_validate(CLI::App& app, int& status) {
    const auto options = std::make_shared<ValidateOptions>();
    CLI::App* command = app.add_subcommand(
        "validate", "Test a plugin's methods against the promises that every method makes");
    command->add_option("PLUGIN", options->plugin, "the plugin's file");
    command->add_option("--method", options->method, "only this method of the plugin");
    add_repeated(*command, "--test", options->tests, "only this test");
    add_repeated(*command, "--set", options->settings, "[METHOD.]PARAM=VALUE for all tests");
    add_seed(*command, options->seed, "random cameras and frame numbers come from it; 1");
    add_device(*command, options->device);
    add_time_limit(*command, options->time_limit_s,
                   "of each test, seconds; a call may take half of it; 30 to 300 by the test");
    const CLI::Validator finite = finite_and_positive("the factor");
    command
        ->add_option("--time-factor", options->time_factor, "stretches each test's time limit; 1")
        ->check(finite);
    command->add_flag("--strict", options->strict,
                      "a warning (a claimed bound that does not hold) is a failure");
    command->add_flag("--json", options->json, "print one JSON object a line");
    command->add_flag("--list", options->list, "list the tests and what each promises");
    command->callback([options, &status] { status = run_validate(*options); });
}

}  // namespace lodbench::cli
