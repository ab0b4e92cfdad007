#include "report/junit.h"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <vector>

#include "base/printable.h"
#include "report/comparison.h"

namespace lodbench::report {

namespace {

enum class Outcome { passed, failure, error, skipped };

struct Case {
    std::string name = {}, group = {};  ///< `group` is JUnit's class
    double seconds = 0;
    Outcome outcome = Outcome::passed;
    std::string message = {};  ///< of what is not passed: one line
    std::string details = {};
    std::string output = {};  ///< of what is passed
};

const char* tag_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::failure: return "failure";
        case Outcome::error: return "error";
        default: return "skipped";
    }
}

std::string case_text(const Case& one) {
    std::string text = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                                   xml_text(one.group), xml_text(one.name), one.seconds);
    if (one.outcome == Outcome::passed) {
        if (one.output.empty()) return text + "/>\n";
        return text +
               fmt::format("><system-out>{}</system-out></testcase>\n", xml_text(one.output));
    }
    const char* tag = tag_of(one.outcome);
    return text + fmt::format("><{} message=\"{}\">{}</{}></testcase>\n", tag,
                              xml_text(one.message), xml_text(one.details), tag);
}

using Suites = std::map<std::string, std::vector<Case>>;

std::string counts_of(const std::vector<Case>& cases) {
    std::size_t failures = 0, errors = 0, skipped = 0;
    double seconds = 0;
    for (const Case& one : cases) {
        failures += one.outcome == Outcome::failure ? 1 : 0;
        errors += one.outcome == Outcome::error ? 1 : 0;
        skipped += one.outcome == Outcome::skipped ? 1 : 0;
        seconds += one.seconds;
    }
    return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"",
                       cases.size(), failures, errors, skipped, seconds);
}

std::string document(const std::string& name, const Suites& suites) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    text += fmt::format("<testsuites name=\"{}\">\n", xml_text(name));
    for (const auto& [suite, cases] : suites) {
        text += fmt::format("  <testsuite name=\"{}\" {}>\n", xml_text(suite), counts_of(cases));
        for (const Case& one : cases) text += case_text(one);
        text += "  </testsuite>\n";
    }
    return text + "</testsuites>\n";
}

Outcome outcome_of(results::CellStatus status) {
    using results::CellStatus;
    switch (status) {
        case CellStatus::ok: return Outcome::passed;
        case CellStatus::skipped: return Outcome::skipped;
        case CellStatus::failed: return Outcome::failure;
        default: return Outcome::error;
    }
}

Case figures_case(const compare::SettingComparison& setting) {
    Case one{.name = setting.label + ": figures", .group = setting.scenario + "." + setting.method};
    std::vector<std::string> lines = setting.failures;
    for (const auto& change : setting.frame_changes) lines.push_back(text_of(change));
    for (const auto& change : setting.changes) lines.push_back(text_of(change));
    if (lines.empty()) {
        one.output = fmt::format("{}", fmt::join(setting.notes, "\n"));
        return one;
    }
    one.outcome = Outcome::failure;
    one.message = lines.front();
    one.details = fmt::format("{}", fmt::join(lines, "\n"));
    return one;
}

Case time_case(const compare::SettingComparison& setting, const compare::TimeComparison& time) {
    Case one{.name = setting.label + ": " + time.figure,
             .group = setting.scenario + "." + setting.method};
    if (!time.device.empty()) one.name += " on " + time.device;
    one.output = one.message = one.details = text_of(time);
    if (time.fails_gate()) one.outcome = Outcome::failure;
    if (time.verdict == compare::TimeVerdict::cannot_tell) one.outcome = Outcome::skipped;
    return one;
}

bool allowed_in_xml(std::string_view character) {
    if (character == "\t" || character == "\n" || character == "\r") return true;
    if (character.size() == 1) return static_cast<unsigned char>(character.front()) >= 0x20;
    return character != "\uFFFE" && character != "\uFFFF";
}

}  // namespace

std::string xml_text(const std::string& text) {
    std::string escaped;
    base::for_each_character(text, [&](std::string_view character, bool well_formed) {
        if (!well_formed || !allowed_in_xml(character)) {
            escaped += base::kReplacement;
        } else if (character == "&") {
            escaped += "&amp;";
        } else if (character == "<") {
            escaped += "&lt;";
        } else if (character == ">") {
            escaped += "&gt;";  // "]]>" may not stand in text
        } else if (character == "\"") {
            escaped += "&quot;";
        } else if (character == "\t" || character == "\n" || character == "\r") {
            escaped += fmt::format("&#{};", int(character.front()));  // attributes would lose them
        } else {
            escaped += character;
        }
    });
    return escaped;
}

std::string junit_of(const results::ResultFolder& folder) {
    Suites suites;
    for (const results::CellRecord& cell : folder.cells) {
        Case one{.name = cell.cell,
                 .group = cell.scenario + "." + cell.method,
                 .seconds = cell.cell_s.value_or(0),
                 .outcome = outcome_of(cell.status)};
        if (one.outcome != Outcome::passed) {
            one.message = fmt::format("{}: {}", name_of(cell.status),
                                      cell.reason.substr(0, cell.reason.find('\n')));
            one.details = cell.reason;
        } else {
            one.output = fmt::format("{}", fmt::join(cell.warnings, "\n"));
        }
        suites[cell.scenario].push_back(std::move(one));
    }
    return document(folder.name, suites);
}

std::string junit_of(const compare::Comparison& comparison) {
    Suites suites;
    for (const compare::SettingComparison& setting : comparison.settings) {
        std::vector<Case>& cases = suites[setting.scenario];
        cases.push_back(figures_case(setting));
        for (const auto& time : setting.times) cases.push_back(time_case(setting, time));
    }
    for (const std::string& setting : comparison.missing) {
        suites["missing"].push_back({.name = setting,
                                     .group = "missing",
                                     .outcome = Outcome::failure,
                                     .message = "BASE has it, NEW does not"});
    }
    return document("comparison of " + comparison.now + " with " + comparison.base, suites);
}

}  // namespace lodbench::report
