#include "results/health.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace lodbench::results {

namespace {

constexpr const char* kWhileTimed = " while it was timed";

void flag_gpu(const HealthFigures& health, std::vector<HealthFlag>& flags) {
    if (health.gpu_throttle && !health.gpu_throttle->empty()) {
        flags.push_back({fmt::format("the GPU was held below its clock ({}){}",
                                     fmt::join(*health.gpu_throttle, ", "), kWhileTimed),
                         {},
                         0,
                         ""});
    }
    if (health.gpu_fall.value_or(0) > kClockFall) {
        flags.push_back({"the GPU's clock fell by ", 100 * *health.gpu_fall, 0,
                         std::string(" %") + kWhileTimed});
    }
    if (health.gpu_c && health.gpu_limit_c && health.gpu_c->max >= *health.gpu_limit_c) {
        flags.push_back(
            {"the GPU reached ", health.gpu_c->max, 0,
             fmt::format(" °C, and from {:.0f} °C on it is slowed down", *health.gpu_limit_c)});
    }
}

void flag_cpu(const HealthFigures& health, std::vector<HealthFlag>& flags) {
    if (health.cpu_throttles.value_or(0) > 0) {
        flags.push_back({"its cores were slowed down for heat ", double(*health.cpu_throttles), 0,
                         std::string(" times") + kWhileTimed});
    }
    if (health.cgroup_held_s.value_or(0) > 0) {
        flags.push_back({"a CPU quota held it back for ", health.cgroup_held_s, 2,
                         std::string(" s of its cores' time") + kWhileTimed});
    }
    if (!health.others_cores || !health.idle_cores || !health.cores) return;
    const double cores = *health.cores;
    if (*health.others_cores > kOthersShare * cores && *health.idle_cores < kIdleShare * cores) {
        flags.push_back(
            {"other programs took ", health.others_cores, 1,
             fmt::format(" of its {} cores{}, and none was idle", *health.cores, kWhileTimed)});
    }
}

/// "repetition 3", "repetitions 0, 2 and 5"
std::string repetitions_text(const std::vector<int>& numbers) {
    std::string text = numbers.size() == 1 ? "repetition " : "repetitions ";
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const char* between = i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ";
        text += fmt::format("{}{}", between, numbers[i]);
    }
    return text;
}

/// Flags of the same words: which repetitions have them, and the range of their figures.
struct Alike {
    std::vector<int> repetitions;
    std::string low_text, high_text;
    std::optional<double> low, high;

    void add(int repetition, const HealthFlag& flag) {
        repetitions.push_back(repetition);
        if (!flag.figure) return;
        low = std::min(low.value_or(*flag.figure), *flag.figure);
        high = std::max(high.value_or(*flag.figure), *flag.figure);
        low_text = fmt::format("{:.{}f}", *low, flag.decimals);
        high_text = fmt::format("{:.{}f}", *high, flag.decimals);
    }
    [[nodiscard]] std::string figures() const {
        return low_text == high_text ? low_text : low_text + " to " + high_text;
    }
};

using ClockOf = std::optional<SensorFigures> HealthFigures::*;

/// That a repetition's mean clock was below another's all the time.
void compare_clocks(const std::vector<const CellRecord*>& cells, ClockOf clock, const char* whose,
                    const auto& add) {
    double highest = 0;
    const auto mean_of = [clock](const CellRecord& cell) {
        const auto mhz = cell.health ? (*cell.health).*clock : std::nullopt;
        return mhz ? mhz->mean.value_or(0) : 0;
    };
    for (const CellRecord* cell : cells) highest = std::max(highest, mean_of(*cell));
    for (const CellRecord* cell : cells) {
        const double mean = mean_of(*cell);
        if (!(mean > 0) || mean >= (1 - kClockFall) * highest) continue;
        add(*cell, HealthFlag{fmt::format("{} clock was ", whose), 100 * (1 - mean / highest), 0,
                              " % below that of its fastest repetition"});
    }
}

}  // namespace

std::vector<HealthFlag> health_flags(const CellRecord& cell) {
    std::vector<HealthFlag> flags;
    if (!cell.health) return flags;
    flag_gpu(*cell.health, flags);
    flag_cpu(*cell.health, flags);
    return flags;
}

std::vector<std::string> health_words(const std::vector<const CellRecord*>& cells) {
    std::map<std::pair<std::string, std::string>, Alike> kinds;
    const auto add = [&kinds](const CellRecord& cell, const HealthFlag& flag) {
        kinds[{flag.before, flag.after}].add(cell.repetition, flag);
    };
    for (const CellRecord* cell : cells) {
        for (const HealthFlag& flag : health_flags(*cell)) add(*cell, flag);
    }
    compare_clocks(cells, &HealthFigures::gpu_mhz, "the GPU's", add);
    compare_clocks(cells, &HealthFigures::cpu_mhz, "the CPU's", add);
    std::vector<std::string> texts;
    for (const auto& [words, alike] : kinds) {
        texts.push_back(fmt::format("{}: {}{}{}", repetitions_text(alike.repetitions), words.first,
                                    alike.figures(), words.second));
    }
    return texts;
}

}  // namespace lodbench::results
