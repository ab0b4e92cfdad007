#pragma once
// A campaign divided among machines: what is compared stays together.

#include <cstddef>
#include <string>
#include <vector>

namespace lodbench::run {

struct Plan;

/// A part of a campaign: number I of N, from 1.
struct Shard {
    int number = 1;
    int count = 1;

    /// "3/8"
    [[nodiscard]] std::string text() const;
    friend bool operator==(const Shard&, const Shard&) = default;
};

/// "I/N", 1 <= I <= N <= 100,000. `where` names the text in messages. Throws InputError.
[[nodiscard]] Shard parse_shard(const std::string& text, const std::string& where);

/// One scenario with all its methods and settings, one whole repetition: its times are compared, so
/// that it is flown on one machine.
struct Block {
    std::string scenario;
    int repetition = 0;
    std::vector<std::size_t> cells;  ///< indices into the plan's, in the order of flight

    /// Blocks are dealt out in turn: repetition 0, which alone measures the truth and so takes
    /// longest, goes to as many machines as there are scenarios.
    [[nodiscard]] static int shard_of(std::size_t block, int count) {
        return int(block % std::size_t(count)) + 1;
    }
};

/// By repetition, and in it by scenario as the plan has them.
[[nodiscard]] std::vector<Block> blocks_of(const Plan& plan);

/// Leaves the shard's cells, with the seeds and in the order that they have in the whole.
void keep_shard(Plan& plan, const Shard& shard);

/// Over the cells and their seeds: equal only for the same campaign. 16 hex digits.
[[nodiscard]] std::string checksum_of(const Plan& plan);

}  // namespace lodbench::run
