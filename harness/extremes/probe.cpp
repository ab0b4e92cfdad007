#include "extremes/probe.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"
#include "base/interrupts.h"
#include "base/isolated.h"
#include "extremes/flight.h"
#include "results/json.h"
#include "run/shared_signs.h"
#include "run/stage.h"
#include "run/supervisor.h"

namespace lodbench::extremes {
namespace {

constexpr const char* kInterrupted = "interrupted";
constexpr const char* kFailed = "failed";
constexpr const char* kSkipped = "skipped";

std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

/// On its way between processes.
std::string write_outcome(const ProbeOutcome& outcome, const char* ending) {
    Json::Value json;
    json["ending"] = ending;
    json["words"] = one_line(outcome.words);
    json["figures"] = results::encode(outcome.figures);
    json["terrain"] = outcome.terrain;
    json["checksum"] = outcome.terrain_checksum;
    json["device"] = outcome.device;
    return results::exact_text(json);
}

ProbeOutcome read_outcome(const std::string& text) {
    const Json::Value json = results::parse_json(text, "answer of a probe");
    ProbeOutcome outcome;
    const std::string ending = json["ending"].asString();
    if (ending == kFailed) outcome.ending = ProbeOutcome::Ending::failed;
    if (ending == kSkipped) outcome.ending = ProbeOutcome::Ending::skipped;
    outcome.words = json["words"].asString();
    outcome.figures =
        results::read_record<results::ExtremesFigures>(json["figures"], "answer of a probe");
    outcome.terrain = json["terrain"].asString();
    outcome.terrain_checksum = json["checksum"].asString();
    outcome.device = json["device"].asString();
    return outcome;
}

/// In the child.
std::string answer_of(const Probe& probe, const scenario::Scenario& scenario,
                      run::VitalSigns& signs) {
    ProbeOutcome outcome;
    try {
        fly_here(probe, scenario, signs, outcome);
        return write_outcome(outcome, "finished");
    } catch (const run::MethodSkipped& skipped) {
        outcome.words = skipped.what();
        return write_outcome(outcome, kSkipped);
    } catch (const run::MethodFailure& failure) {
        outcome.words = failure.what();
        return write_outcome(outcome, kFailed);
    }
}

std::string place_of(const run::VitalSigns& signs) {
    const run::Call call = signs.call.load();
    if (call == run::Call::none) return "between the method's calls";
    const int frame = signs.frame.load();
    return fmt::format("in {}{}", run::name_of(call),
                       frame >= 0 ? fmt::format(", frame {}", frame) : "");
}

}  // namespace

ProbeOutcome fly(const Probe& probe) {
    if (base::interrupted()) throw run::Interrupted();
    const scenario::Scenario scenario = scenario::load_scenario(probe.scenario, probe.overrides);
    const auto signs = run::map_signs();
    run::HangWatch watch(signs, scenario.frame_time_limit_s);
    const base::Allowance allowance{scenario.cell_time_limit_s, scenario.memory_limit_bytes};
    const base::Answer answer = base::run_isolated(
        allowance, [&] { return answer_of(probe, scenario, *signs); },
        [&]() -> std::string {
            if (base::interrupted()) return kInterrupted;
            const run::Call call = watch.hung_in();
            // Loading and measuring are the harness's, and may take their time.
            if (call < run::Call::create) return {};
            return fmt::format("no sign of life for {:g} s", scenario.frame_time_limit_s);
        });
    if (base::interrupted()) throw run::Interrupted();
    ProbeOutcome outcome;
    outcome.words = one_line(answer.text);
    switch (answer.ending) {
        case base::Ending::answered: return read_outcome(answer.text);
        case base::Ending::refused: throw InputError(answer.text);
        case base::Ending::environment_error: throw EnvironmentError(answer.text);
        case base::Ending::threw: outcome.ending = ProbeOutcome::Ending::failed; break;
        case base::Ending::died: outcome.ending = ProbeOutcome::Ending::crashed; break;
        case base::Ending::timed_out:
            outcome.ending = answer.out_of_memory ? ProbeOutcome::Ending::out_of_memory
                                                  : ProbeOutcome::Ending::hung;
            break;
    }
    outcome.words += " " + place_of(*signs);
    return outcome;
}

}  // namespace lodbench::extremes
