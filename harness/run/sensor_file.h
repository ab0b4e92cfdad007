#pragma once
// Files of sysfs and procfs that hold one value each. What is not there, cannot be read or holds
// something else is nothing: no sensor's failure ends a flight.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lodbench::run {

/// The first line, at most 4 KiB, without spaces at its ends. Nothing where it is empty.
[[nodiscard]] std::optional<std::string> line_in(const std::filesystem::path& file);

/// All of a file, at most 64 KiB; "" where it cannot be read.
[[nodiscard]] std::string text_in(const std::filesystem::path& file);

/// A line that is one decimal number and nothing else, divided by `unit`. Nothing for a negative
/// one: no sensor that is read here has any.
[[nodiscard]] std::optional<double> number_in(const std::filesystem::path& file, double unit = 1);

/// The same, where 0 says that the sensor sleeps.
[[nodiscard]] std::optional<double> positive_in(const std::filesystem::path& file, double unit = 1);

/// Of a folder, the paths of those entries whose names begin so, in alphabetical order.
[[nodiscard]] std::vector<std::filesystem::path> entries(const std::filesystem::path& folder,
                                                         const std::string& prefix);

}  // namespace lodbench::run
