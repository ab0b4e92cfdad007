#pragma once
// The hashes of the house: the first names what lies in memory, the second what lies in files that
// are read often, the third draws numbers. All give the same on every machine, which the standard
// library's do not promise.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include <fmt/format.h>

namespace lodbench::base {

/// FNV-1a, 64 bits (Fowler, Noll and Vo), over little-endian words of 32 bits.
class Fnv1a {
public:
    void add(std::uint32_t word) {
        for (int shift = 0; shift < 32; shift += 8) {
            state_ = (state_ ^ ((word >> shift) & 0xFFU)) * 0x100000001b3ULL;
        }
    }
    /// 16 hex digits.
    [[nodiscard]] std::string hex() const { return fmt::format("{:016x}", state_); }
    [[nodiscard]] std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// Over little-endian words of 64 bits, a word every few cycles, for what is read often: tiles.
/// A change within one word always changes the result; any other goes unseen once in 2^64.
class WordHash {
public:
    void add(std::uint64_t word) {
        // Both steps can be undone, so two different states or words never meet in one.
        state_ = (state_ ^ word) * 0x9fb21c651e98df25ULL;
        state_ ^= state_ >> 32U;
    }
    /// Whole words, and at the end what is left of one, filled up with zeros. Bytes may come in
    /// pieces, all but the last of them a multiple of 8 long.
    void add(std::span<const std::byte> bytes) {
        std::size_t place = 0;
        for (; place + 8 <= bytes.size(); place += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data() + place, 8);
            add(little_endian(word));
        }
        if (place == bytes.size()) return;
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + place, bytes.size() - place);
        add(little_endian(word));
    }
    [[nodiscard]] std::uint64_t value() const { return state_; }

private:
    static std::uint64_t little_endian(std::uint64_t word) {
        if constexpr (std::endian::native == std::endian::little) {
            return word;
        } else {
            return __builtin_bswap64(word);
        }
    }
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// 2^64 divided by the golden ratio, odd: SplitMix64's step.
inline constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;

/// What SplitMix64 gives for the state `bits`: every bit of it reaches every bit of the result.
[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t bits) {
    bits += kGolden;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
    return bits ^ (bits >> 31U);
}

/// Steele, Lea and Flood: Fast splittable pseudorandom number generators, 2014; its finaliser by
/// Stafford.
class SplitMix64 {
public:
    explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        const std::uint64_t value = mix64(state_);
        state_ += kGolden;
        return value;
    }
    /// Uniform in [0, bound), bound > 0; the incomplete last stretch of 2^64 is drawn again.
    std::uint64_t below(std::uint64_t bound) {
        constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
        const std::uint64_t limit = kMax - kMax % bound;
        std::uint64_t value = next();
        while (value >= limit) value = next();
        return value % bound;
    }
    /// Passes over `count` numbers.
    void skip(std::uint64_t count) { state_ += kGolden * count; }

private:
    std::uint64_t state_;
};

}  // namespace lodbench::base
