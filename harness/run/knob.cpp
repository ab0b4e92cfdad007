#include "run/knob.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lodbench::run {
namespace {

constexpr double kStep = 4;      // of the search for a bracket, as a factor
constexpr double kSlack = 1.02;  // by which neighbouring probes may go the wrong way

/// ln(value / target), within bounds where the value is 0 or infinite.
double distance(double value, double target) {
    constexpr double kFarthest = 50;
    return std::clamp(std::log(value / target), -kFarthest, kFarthest);
}

class Search {
public:
    Search(const Knob& knob, double target, double tolerance, int most_probes,
           const std::function<std::optional<double>(double)>& measure)
        : knob_(knob),
          target_(target),
          tolerance_(tolerance),
          most_probes_(most_probes),
          measure_(measure) {}

    SearchResult run() {
        search();
        result_.monotone = is_monotone();
        return std::move(result_);
    }

private:
    struct Place {
        double x = 0;  ///< on the knob's own scale
        double y = 0;  ///< distance
    };

    [[nodiscard]] double scaled(double knob) const {
        return knob_.geometric() ? std::log(knob) : knob;
    }
    [[nodiscard]] double knob_at(double x) const {
        return knob_.admitted(knob_.geometric() ? std::exp(x) : x);
    }
    [[nodiscard]] double step() const {
        return knob_.geometric() ? std::log(kStep) : (knob_.maximum - knob_.minimum) / kStep;
    }

    /// Nothing where the probe failed, or where no more may be asked.
    std::optional<Place> probe(double knob) {
        for (const Probe& known : result_.probes) {
            if (known.knob != knob) continue;
            if (!known.value) return std::nullopt;
            return Place{scaled(knob), distance(*known.value, target_)};
        }
        if (int(result_.probes.size()) >= most_probes_) return std::nullopt;
        const std::optional<double> value = measure_(knob);
        result_.probes.push_back({knob, value});
        if (!value || std::isnan(*value)) {
            result_.probes.back().value.reset();
            return std::nullopt;
        }
        const Place place{scaled(knob), distance(*value, target_)};
        if (!result_.best ||
            std::abs(place.y) <= std::abs(distance(*result_.best->value, target_))) {
            result_.best = result_.probes.back();
        }
        if (*value >= target_ * (1 - tolerance_) && *value <= target_ * (1 + tolerance_)) {
            result_.outcome = SearchOutcome::met;
        }
        return place;
    }
    [[nodiscard]] bool met() const { return result_.outcome == SearchOutcome::met; }

    void search() {
        const std::optional<Place> start = probe(knob_.admitted(knob_.start));
        if (!start || met()) return;
        // Which way leads towards the target is found by going one. A step nearer says little of
        // it: an error need not rise with the knob, so the other way is gone too before a target
        // counts as out of reach.
        for (const double direction : {1.0, -1.0}) {
            Place from = *start;
            int farther = 0;  // steps in a row
            while (!met()) {
                const double knob = knob_at(from.x + direction * step());
                if (scaled(knob) == from.x) break;  // the range's end
                const std::optional<Place> next = probe(knob);
                if (!next || met()) break;
                if ((next->y > 0) != (from.y > 0)) return narrow(from, *next);
                // Once may be chance: where a method is far better than asked, its error is noise.
                farther = std::abs(next->y) > std::abs(from.y) ? farther + 1 : 0;
                if (farther == 2) break;
                from = *next;
            }
            if (met()) return;
        }
    }

    /// One of the two places lies above the target, the other below.
    void narrow(Place one, Place other) {
        int moved = 0;  // which end the last probe replaced: 1 or 2
        bool again = false;
        while (!are_close(one, other)) {
            // The slope's guess, but never so near an end that the other hardly moves; where one
            // end has moved twice in a row, as at a jump, the middle.
            const double guess = again ? 0.5 : one.y / (one.y - other.y);
            const double x = one.x + std::clamp(guess, 0.1, 0.9) * (other.x - one.x);
            const double knob = knob_at(x);
            const bool known =
                std::ranges::find(result_.probes, knob, &Probe::knob) != result_.probes.end();
            const double middle = knob_at(0.5 * (one.x + other.x));
            const bool all_known =
                std::ranges::find(result_.probes, middle, &Probe::knob) != result_.probes.end();
            if (known && all_known) break;
            const std::optional<Place> next = probe(known ? middle : knob);
            if (met()) return;
            if (!next) break;
            const int end = (next->y > 0) == (one.y > 0) ? 1 : 2;
            (end == 1 ? one : other) = *next;
            again = end == moved;
            moved = end;
        }
        result_.outcome = SearchOutcome::between;
    }

    /// Nothing between them is another value for whom the tolerance will do.
    [[nodiscard]] bool are_close(const Place& one, const Place& other) const {
        const double a = knob_at(one.x), b = knob_at(other.x);
        return std::abs(a - b) <= 0.1 * tolerance_ * std::max(std::abs(a), std::abs(b));
    }

    [[nodiscard]] bool is_monotone() const {
        std::vector<Probe> sorted;
        std::ranges::copy_if(result_.probes, std::back_inserter(sorted),
                             [](const Probe& probe) { return probe.value.has_value(); });
        std::ranges::sort(sorted, {}, &Probe::knob);
        bool rises = true;
        bool falls = true;
        for (std::size_t i = 1; i < sorted.size(); ++i) {
            rises = rises && *sorted[i].value * kSlack >= *sorted[i - 1].value;
            falls = falls && *sorted[i].value <= *sorted[i - 1].value * kSlack;
        }
        return rises || falls;
    }

    const Knob& knob_;
    double target_, tolerance_;
    int most_probes_;
    const std::function<std::optional<double>(double)>& measure_;
    SearchResult result_;
};

}  // namespace

double Knob::admitted(double value) const {
    value = std::clamp(value, minimum, maximum);
    if (integer) return std::clamp(std::round(value), std::ceil(minimum), std::floor(maximum));
    // Four digits say more than any tolerance asks, and read well in tables and file names.
    double rounded = value;
    const std::string digits = fmt::format("{:.3e}", value);
    std::from_chars(digits.data(), digits.data() + digits.size(), rounded);
    return std::clamp(rounded, minimum, maximum);
}

std::string Knob::text(double value) const {
    return integer ? fmt::format("{:.0f}", value) : fmt::format("{}", value);
}

std::optional<Knob> quality_knob(const MethodInfo& method) {
    const auto param = std::ranges::find(method.params, method.quality_knob, &ParamInfo::name);
    if (method.quality_knob.empty() || param == method.params.end()) return std::nullopt;
    if (param->type != ParamType::integer && param->type != ParamType::real) return std::nullopt;
    return Knob{param->name, param->type == ParamType::integer, param->minimum, param->maximum,
                param->default_number};
}

std::vector<double> sweep_values(const Knob& knob, int points) {
    constexpr double kFactor = 2;
    std::vector<double> values;
    for (int i = 0; i < points; ++i) {
        const int steps = i - (points - 1) / 2;
        const double value = knob.geometric()
                                 ? knob.start * std::pow(kFactor, steps)
                                 : knob.start + steps * (knob.maximum - knob.minimum) / 10;
        if (value < knob.minimum || value > knob.maximum) continue;
        values.push_back(knob.admitted(value));
    }
    if (values.empty()) values.push_back(knob.admitted(knob.start));
    std::ranges::sort(values);
    values.erase(std::ranges::unique(values).begin(), values.end());
    return values;
}

const char* name_of(SearchOutcome outcome) {
    switch (outcome) {
        case SearchOutcome::met: return "met";
        case SearchOutcome::unreachable: return "unreachable";
        case SearchOutcome::between: break;
    }
    return "between";
}

SearchResult search_knob(const Knob& knob, double target, double tolerance, int most_probes,
                         const std::function<std::optional<double>(double)>& measure) {
    return Search(knob, target, tolerance, most_probes, measure).run();
}

}  // namespace lodbench::run
