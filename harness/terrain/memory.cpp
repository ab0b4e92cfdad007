#include "terrain/memory.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

/// 262144 a side: what a raster may claim to have, that is read row by row.
constexpr std::int64_t kMostSamplesRead = std::int64_t(1) << 36;
constexpr std::int64_t kMostSamplesHeld = std::int64_t(1) << 31;
constexpr std::int64_t kMostSide = std::int64_t(1) << 30;

void check_count(const std::string& what, std::int64_t rows, std::int64_t columns,
                 std::int64_t most, const char* done, const std::string& remedy) {
    if (rows < 2 || columns < 2) {
        throw InputError(fmt::format(
            "{}: {} rows x {} columns make no surface; at least 2 x 2 samples are needed", what,
            rows, columns));
    }
    // Divided, not multiplied: both may be anything.
    if (rows > most / columns || rows > kMostSide || columns > kMostSide) {
        throw InputError(
            fmt::format("{}: {} rows x {} columns are more than the {} samples that are {}; {}",
                        what, rows, columns, most, done, remedy));
    }
}

}  // namespace

std::optional<std::int64_t> available_memory() {
    std::ifstream stream("/proc/meminfo");
    std::string key;
    std::int64_t kibibytes = 0;
    std::string unit;
    while (stream >> key >> kibibytes) {
        std::getline(stream, unit);
        if (key == "MemAvailable:") return kibibytes * 1024;
    }
    return std::nullopt;
}

void check_grid_size(const std::string& what, std::int64_t rows, std::int64_t columns) {
    check_count(what, rows, columns, kMostSamplesRead, "read", "crop or thin it");
}

void check_field_size(const std::string& what, std::int64_t rows, std::int64_t columns,
                      const std::string& remedy) {
    check_count(what, rows, columns, kMostSamplesHeld, "held in memory", remedy);
    const std::int64_t bytes = rows * columns * std::int64_t(sizeof(float));
    if (const auto free = available_memory(); free && bytes > *free) {
        throw InputError(
            fmt::format("{}: {} rows x {} columns need {} MiB, {} MiB of memory are free; {}", what,
                        rows, columns, bytes >> 20, *free >> 20, remedy));
    }
}

}  // namespace lodbench::terrain
