// A campaign divided: whatever is compared stays together, and nothing is lost or flown twice.

#include "run/shard.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "api/error.h"
#include "run/expected_time.h"
#include "run/plan.h"

namespace lodbench::run {
namespace {

using testing::HasSubstr;

/// Scenarios of 1 to 5 repetitions, one or more methods each.
Plan plan_of(std::mt19937& random) {
    Plan plan;
    const auto scenarios = random() % 4 + 1;
    for (unsigned s = 0; s < scenarios; ++s) {
        plan.scenarios.emplace_back().name = fmt::format("s{}", s);
        const int repetitions = int(random() % 5) + 1;
        const auto methods = random() % 4 + 1;
        for (unsigned m = 0; m < methods; ++m) {
            for (int r = 0; r < repetitions; ++r) {
                PlannedCell cell;
                cell.scenario = plan.scenarios.back().name;
                cell.spec.method = fmt::format("m{}", m);
                cell.spec.repetition = r;
                cell.spec.id = fmt::format("m{}__s{}__r{}", m, s, r);
                plan.cells.push_back(cell);
            }
        }
    }
    interleave(plan.cells, random());
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        plan.cells[i].place = i;
        plan.cells[i].spec.seed = random();
    }
    return plan;
}

TEST(Shards, of_any_campaign_are_a_partition_that_splits_no_block_and_keeps_order_and_seeds) {
    std::mt19937 random(24);
    for (int trial = 0; trial < 200; ++trial) {
        const Plan whole = plan_of(random);
        const int count = int(random() % 12) + 1;
        std::map<std::pair<std::string, int>, int> shard_of_block;
        std::set<std::string> flown;
        for (int number = 1; number <= count; ++number) {
            Plan part = whole;
            keep_shard(part, {number, count});
            EXPECT_TRUE(std::ranges::is_sorted(part.cells, {}, &PlannedCell::place));
            EXPECT_EQ(part.scenarios.size(), whole.scenarios.size());
            for (const PlannedCell& cell : part.cells) {
                EXPECT_TRUE(flown.insert(cell.spec.id).second) << cell.spec.id << " twice";
                EXPECT_EQ(cell.spec.seed, whole.cells[cell.place].spec.seed);
                EXPECT_EQ(cell.spec.id, whole.cells[cell.place].spec.id);
                const auto block =
                    shard_of_block.emplace(std::pair(cell.scenario, cell.spec.repetition), number);
                EXPECT_EQ(block.first->second, number) << cell.spec.id << " is apart";
            }
        }
        EXPECT_EQ(flown.size(), whole.cells.size());
    }
}

TEST(Shards, have_no_more_than_one_block_more_than_another) {
    std::mt19937 random(25);
    for (int trial = 0; trial < 50; ++trial) {
        const std::size_t blocks = blocks_of(plan_of(random)).size();
        const int count = int(random() % 12) + 1;
        std::vector<int> sizes(std::size_t(count), 0);
        for (std::size_t i = 0; i < blocks; ++i) {
            ++sizes.at(std::size_t(Block::shard_of(i, count) - 1));
        }
        EXPECT_LE(std::ranges::max(sizes) - std::ranges::min(sizes), 1);
    }
}

TEST(Shards, that_are_none_are_refused_with_the_form) {
    for (const char* text : {"", "3", "0/2", "3/2", "-1/2", "1/0", "1/2/3", "a/b", "1/", "/2",
                             "1/100001", "99999999999/2", "1 /2"}) {
        try {
            (void)parse_shard(text, fmt::format("--shard {}", text));
            ADD_FAILURE() << "accepted " << text;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(fmt::format("--shard {}: expected I/N", text)));
        }
    }
    EXPECT_EQ(parse_shard("3/8", "").text(), "3/8");
    EXPECT_EQ(parse_shard("100000/100000", "").number, 100000);
}

TEST(Shards, know_their_campaign_by_cells_and_seeds) {
    std::mt19937 random(26);
    const Plan plan = plan_of(random);
    Plan other = plan;
    EXPECT_EQ(checksum_of(plan), checksum_of(other));
    ++other.cells.back().spec.seed;
    EXPECT_NE(checksum_of(plan), checksum_of(other));
    other = plan;
    other.cells.back().spec.id += "0";
    EXPECT_NE(checksum_of(plan), checksum_of(other));
}

results::CellRecord earlier(const char* scenario, const char* method, int repetition,
                            double seconds, double tau) {
    results::CellRecord cell;
    cell.scenario = scenario;
    cell.method = method;
    cell.repetition = repetition;
    cell.params.set("tau", tau);
    if (seconds > 0) cell.cell_s = seconds;
    return cell;
}

PlannedCell planned(const char* scenario, const char* method, int repetition, double tau) {
    PlannedCell cell;
    cell.scenario = scenario;
    cell.spec.method = method;
    cell.spec.repetition = repetition;
    cell.params.set("tau", tau);
    return cell;
}

TEST(ExpectedTimes, are_medians_of_what_is_nearest_to_the_cell) {
    const ExpectedTimes times({earlier("s", "m", 0, 10, 1), earlier("s", "m", 1, 2, 1),
                               earlier("s", "m", 2, 3, 1), earlier("s", "m", 3, 40, 1),
                               earlier("s", "m", 1, 7, 2), earlier("t", "n", 0, 100, 1),
                               earlier("t", "n", 1, 0, 1)});
    EXPECT_EQ(times.of(planned("s", "m", 0, 1)), 10) << "the truth takes its time";
    EXPECT_EQ(times.of(planned("s", "m", 9, 1)), 3) << "median of three later repetitions";
    EXPECT_EQ(times.of(planned("s", "m", 1, 2)), 7) << "its own setting";
    EXPECT_EQ(times.of(planned("s", "m", 1, 3)), 5) << "median of 2, 3, 7 and 40";
    EXPECT_EQ(times.of(planned("u", "n", 0, 1)), 100) << "its method elsewhere";
    EXPECT_EQ(times.of(planned("s", "x", 0, 1)), 55) << "all first repetitions";
    const ExpectedTimes first_only({earlier("s", "m", 0, 10, 1)});
    EXPECT_EQ(first_only.of(planned("s", "m", 3, 1)), 10);
    EXPECT_EQ(ExpectedTimes({}).of(planned("s", "m", 0, 1)), std::nullopt);
}

}  // namespace
}  // namespace lodbench::run
