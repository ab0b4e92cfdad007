#include "run/match.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "api/error.h"
#include "base/files.h"
#include "measure/statistics.h"
#include "results/json.h"
#include "results/run_folder.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

/// The plugins' methods that the request flies, in order of their ids.
std::vector<MethodInfo> methods_of(const Plan& plan, const std::vector<PluginListing>& plugins) {
    std::set<std::string> ids;
    for (const PlannedCell& cell : plan.cells) ids.insert(cell.spec.method);
    std::vector<MethodInfo> methods;
    for (const std::string& id : ids) methods.push_back(find_method(plugins, id, "match"));
    return methods;
}

/// The search begins at the value that the scenario keeps.
std::optional<Knob> knob_to_find(const MethodInfo& info, const scenario::Scenario& scenario) {
    std::optional<Knob> knob = quality_knob(info);
    const auto kept = knob ? kept_knob(scenario, info) : std::nullopt;
    if (!kept) return knob;
    const Params params = make_params(info, {*kept}, scenario.name);
    knob->start = knob->integer ? double(params.integer(knob->name)) : params.real(knob->name);
    return knob;
}

/// Each method has one setting: a swept one would make several surfaces, each with a knob of its
/// own.
void require_one_setting(const Plan& plan, const std::string& method,
                         const std::optional<Knob>& knob) {
    const PlannedCell* first = nullptr;
    for (const PlannedCell& cell : plan.cells) {
        if (cell.spec.method != method) continue;
        if (first == nullptr) first = &cell;
        if (cell.spec.settings != first->spec.settings) {
            throw InputError(
                fmt::format("match: method '{}' is flown with several settings; give each of its "
                            "parameters one "
                            "value",
                            method));
        }
    }
    if (first == nullptr || !knob) return;
    for (const auto& [name, value] : first->spec.settings) {
        if (name != knob->name) continue;
        throw InputError(
            fmt::format("match: {}.{} is set to {}, and it is what is to be found; leave it out",
                        method, name, value));
    }
}

/// Watches the campaigns of the probes: passes on warnings, once, and where the search stands.
class ProbeWatch final : public CampaignObserver {
public:
    ProbeWatch(CampaignObserver& observer, SearchObserver& search, int methods, int most_probes)
        : observer_(observer), search_(search) {
        place_.method_count = methods;
        place_.method_number = 0;
        place_.most_probes = most_probes;
    }
    void next_method(const std::string& method) {
        place_.method = method;
        ++place_.method_number;
        place_.probe = 0;
    }
    void next_probe() { ++place_.probe; }
    /// By this command: a search that is taken up waits for no probe that was flown before.
    [[nodiscard]] int flown() const { return flown_; }
    void begin_flight() { begun_ = Clock::now(); }
    /// At the end of a flight.
    [[nodiscard]] SearchPlace place() { return place_at(1); }

    void warned(const std::string& warning) override {
        if (told_.insert(warning).second) observer_.warned(warning);
    }
    void noisy(const std::string& words) override { observer_.noisy(words); }
    void cooling_down(double left_s) override { observer_.cooling_down(left_s); }
    void cell_progress(const PlannedCell&, std::size_t, std::size_t, double fraction) override {
        search_.flying(place_at(fraction));
    }
    void cell_finished(const PlannedCell&, std::size_t, std::size_t,
                       const results::CellRecord&) override {
        // Those that a search before this one flew are not among them.
        flown_s_ += std::chrono::duration<double>(Clock::now() - begun_).count();
        ++flown_;
    }

private:
    using Clock = std::chrono::steady_clock;
    SearchPlace place_at(double fraction) {
        place_.fraction = fraction;
        const double of_this = place_.most_probes - place_.probe + 1 - fraction;
        const double of_others =
            double(place_.method_count - place_.method_number) * place_.most_probes;
        if (flown_ > 0) place_.most_left_s = flown_s_ / flown_ * (of_this + of_others);
        return place_;
    }
    CampaignObserver& observer_;
    SearchObserver& search_;
    SearchPlace place_;
    Clock::time_point begun_;
    double flown_s_ = 0;
    int flown_ = 0;
    std::set<std::string> told_;
};

/// Of the frames that the economy names, those that `every` measures too: the others would join
/// the figures of the final flights, and were in those of no probe.
std::vector<int> economy_of_measured_frames(const scenario::Scenario& scenario) {
    std::vector<int> frames;
    std::ranges::copy_if(scenario.measure.economy, std::back_inserter(frames),
                         [&](int frame) { return frame % scenario.measure.every == 0; });
    return frames;
}

void write_record(const fs::path& file, const results::MatchRecord& record) {
    base::write_whole(file, results::seal(to_json(record), true) + "\n");
}

/// The folder, locked. Says whose it is before the first probe: by a match.json that is as yet
/// without methods. Throws InputError where the folder holds something else.
results::RunFolder begin_search(const RunRequest& request, const results::MatchTarget& target) {
    const fs::path file = request.out / "match.json";
    if (!fs::exists(file)) {
        if (results::holds_a_run(request.out)) {
            throw InputError(
                fmt::format("{}: the run in this folder was not begun by match; "
                            "choose another with --out",
                            request.out.string()));
        }
        results::RunFolder folder(fs::absolute(request.out).lexically_normal());
        results::MatchRecord begun;
        begun.target = target;
        write_record(file, begun);
        return folder;
    }
    if (!request.resume) {
        throw InputError(
            fmt::format("{}: there is already a match.json in this folder; go on with it by the "
                        "same command and --resume, or choose another with --out",
                        request.out.string()));
    }
    const results::MatchTarget begun =
        results::read_match(results::parse_sealed(base::read_text(file), file.string()),
                            file.string())
            .target;
    if (begun.words() != target.words() || begun.tolerance != target.tolerance) {
        throw InputError(fmt::format(
            "--resume: the search in {} has another target: {} within {} %, and now {} within {} "
            "%; give the target that it began with",
            file.string(), begun.words(), 100 * begun.tolerance, target.words(),
            100 * target.tolerance));
    }
    return results::RunFolder(fs::absolute(request.out).lexically_normal());
}

}  // namespace

results::MatchRecord match_record(const results::MatchTarget& target,
                                  const std::vector<MatchedMethod>& methods) {
    results::MatchRecord record;
    record.target = target;
    for (const MatchedMethod& method : methods) {
        results::MatchRecord::Method& entry = record.methods.emplace_back();
        entry.method = method.method;
        if (!method.failure.empty()) entry.failure = method.failure;
        if (!method.knob) continue;
        entry.knob = method.knob->name;
        entry.outcome = name_of(method.search.outcome);
        entry.monotone = method.search.monotone;
        if (const auto& best = method.search.best) {
            entry.knob_value = best->knob;
            entry.achieved = best->value;
        }
        for (const Probe& probe : method.search.probes) {
            entry.probes.push_back({probe.knob, probe.value});
        }
    }
    return record;
}

MatchOutcome match(const RunRequest& asked, const results::MatchTarget& target, int most_probes,
                   const fs::path& program, CampaignObserver& observer, SearchObserver& search) {
    const bool of_the_truth = target.quantity == results::MatchTarget::Quantity::pixel_error;
    RunRequest request = asked;
    request.kept_knobs = false;
    const auto override_with = [](RunRequest& changed, const char* key, const std::string& toml) {
        changed.overrides.set(key, toml, "match");
    };
    if (of_the_truth) override_with(request, "measure.truth", "true");
    if (request.scenarios.size() > 1) {
        throw InputError("match: name one scenario; a knob that fits one flight fits no other");
    }
    const std::vector<PluginListing> plugins = list_plugins(plugin_folders(request.plugin_dirs));
    const Plan plan = make_plan(request, plugins);
    MatchOutcome outcome;
    for (const MethodInfo& info : methods_of(plan, plugins)) {
        MatchedMethod& method = outcome.methods.emplace_back();
        method.method = info.id;
        method.knob = knob_to_find(info, plan.scenarios.front());
        method.asynchronous = (info.capabilities & kAsynchronous) != 0;
        require_one_setting(plan, info.id, method.knob);
    }

    const bool fresh = !fs::exists(request.out / "match.json");
    std::optional<results::RunFolder> folder = begin_search(request, target);
    folder->make_parts();  // the probes keep their views of the terrain for each other

    const auto settings_of = [&request](const std::string& method) {
        std::vector<std::string> settings;
        std::ranges::copy_if(
            request.settings, std::back_inserter(settings),
            [&](const std::string& setting) { return setting.starts_with(method + "."); });
        return settings;
    };
    const auto searched = std::ranges::count_if(
        outcome.methods, [](const MatchedMethod& method) { return method.knob.has_value(); });
    ProbeWatch watch(observer, search, int(searched), most_probes);
    int probes_flown = 0;
    for (MatchedMethod& method : outcome.methods) {
        if (!method.knob) continue;
        watch.next_method(method.method);
        int number = 0;
        const auto fly = [&](double value) -> std::optional<double> {
            RunRequest probe = request;
            probe.methods = {method.method};
            probe.settings = settings_of(method.method);
            probe.settings.push_back(fmt::format("{}.{}={}", method.method, method.knob->name,
                                                 method.knob->text(value)));
            probe.views = folder->views();
            probe.out = request.out / "search" / fmt::format("{}-{:02}", method.method, number++);
            override_with(probe, "run.repetitions", "1");
            override_with(probe, "measure.truth", of_the_truth ? "true" : "false");
            override_with(probe, "measure.economy", "[]");
            override_with(probe, "measure.whole", "false");
            // The error that is to be equal is the pixels'.
            override_with(probe, "measure.pixels_only", "true");
            if (watch.flown() > 0) cool_down(request.cool_down_s.value_or(0), watch);
            watch.begin_flight();
            const CampaignOutcome flown = [&] {
                try {
                    return run_campaign(probe, program, watch);
                } catch (const InputError&) {
                    if (fresh && probes_flown == 0) folder->discard();
                    throw;
                }
            }();
            ++probes_flown;
            if (!flown.error.empty()) throw EnvironmentError(flown.error);
            const results::CellRecord& cell = flown.cells.front();
            const auto measured = target.measured(cell);
            std::string failure;
            if (!measured) {
                failure = cell.reason.empty() ? "the quantity was not measured" : cell.reason;
                method.failure = failure;
            }
            search.probed(watch.place(), method, {value, measured}, failure);
            return measured;
        };
        const auto measure = [&](double value) {
            watch.next_probe();
            const std::optional<double> once = fly(value);
            if (!once || !method.asynchronous || !target.meets(*once)) return once;
            // Its error differs from flight to flight: once within the tolerance may be chance.
            std::vector<double> values = {*once};
            for (int again = 0; again < 2; ++again) {
                if (const auto value_again = fly(value)) values.push_back(*value_again);
            }
            return measure::median(values);
        };
        method.search =
            search_knob(*method.knob, target.value, target.tolerance, most_probes, measure);
    }

    RunRequest final = request;
    override_with(
        final, "measure.economy",
        fmt::format("[{}]", fmt::join(economy_of_measured_frames(plan.scenarios.front()), ", ")));
    final.methods.clear();
    for (const MatchedMethod& method : outcome.methods) {
        if (method.knob && !method.search.best) continue;  // no value of its knob could be flown
        final.methods.push_back(method.method);
        if (!method.knob) continue;
        final.settings.push_back(fmt::format("{}.{}={}", method.method, method.knob->name,
                                             method.knob->text(method.search.best->knob)));
    }
    std::erase_if(final.settings, [&](const std::string& setting) {
        return std::ranges::none_of(final.methods, [&](const std::string& method) {
            return setting.starts_with(method + ".");
        });
    });
    if (final.methods.empty()) {
        throw EnvironmentError(
            fmt::format("match: no method could be flown; the last said: {}",
                        outcome.methods.empty() ? "" : outcome.methods.back().failure));
    }
    write_record(request.out / "match.json", match_record(target, outcome.methods));
    folder.reset();  // the campaign locks it for itself
    if (watch.flown() > 0) cool_down(request.cool_down_s.value_or(0), observer);
    outcome.campaign = run_campaign(final, program, observer);
    return outcome;
}

}  // namespace lodbench::run
