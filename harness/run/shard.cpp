#include "run/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <utility>

#include "api/error.h"
#include "results/json.h"
#include "run/plan.h"

namespace lodbench::run {

std::string Shard::text() const {
    return fmt::format("{}/{}", number, count);
}

Shard parse_shard(const std::string& text, const std::string& where) {
    constexpr int kMost = 100'000;
    Shard shard;
    const char* end = text.data() + text.size();
    const auto number = std::from_chars(text.data(), end, shard.number);
    if (number.ec == std::errc() && number.ptr != end && *number.ptr == '/') {
        const auto count = std::from_chars(number.ptr + 1, end, shard.count);
        if (count.ec == std::errc() && count.ptr == end && shard.number >= 1 &&
            shard.number <= shard.count && shard.count <= kMost) {
            return shard;
        }
    }
    throw InputError(
        fmt::format("{}: expected I/N, part I of N with 1 <= I <= N <= {}, as 3/8", where, kMost));
}

std::vector<Block> blocks_of(const Plan& plan) {
    std::map<std::string, std::size_t> scenarios;
    for (const scenario::Scenario& scenario : plan.scenarios) {
        scenarios.emplace(scenario.name, scenarios.size());
    }
    std::map<std::pair<int, std::size_t>, Block> blocks;
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        const PlannedCell& cell = plan.cells[i];
        const int repetition = cell.spec.repetition;
        Block& block = blocks[{repetition, scenarios.at(cell.scenario)}];
        block.scenario = cell.scenario;
        block.repetition = repetition;
        block.cells.push_back(i);
    }
    std::vector<Block> result;
    for (auto& [key, block] : blocks) result.push_back(std::move(block));
    return result;
}

void keep_shard(Plan& plan, const Shard& shard) {
    std::vector<std::size_t> kept;
    const std::vector<Block> blocks = blocks_of(plan);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (Block::shard_of(i, shard.count) != shard.number) continue;
        kept.insert(kept.end(), blocks[i].cells.begin(), blocks[i].cells.end());
    }
    std::ranges::sort(kept);
    std::vector<PlannedCell> cells;
    for (const std::size_t i : kept) cells.push_back(std::move(plan.cells[i]));
    plan.cells = std::move(cells);
}

std::string checksum_of(const Plan& plan) {
    std::string text;
    for (const PlannedCell& cell : plan.cells) {
        text += fmt::format("{} {}\n", cell.spec.id, cell.spec.seed);
    }
    return results::checksum_of(text);
}

}  // namespace lodbench::run
