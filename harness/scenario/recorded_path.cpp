#include "scenario/recorded_path.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "api/error.h"
#include "base/printable.h"

namespace lodbench::scenario {
namespace {

constexpr std::string_view kHeader = "frame,x,y,z,heading,pitch,roll";
constexpr std::string_view kNames[7] = {"frame", "x", "y", "z", "heading", "pitch", "roll"};
constexpr std::uintmax_t kMaxBytes = 256ULL << 20U;
constexpr double kMaxMagnitude = 1e9;  // metres; beyond it a double no longer resolves a micrometre

/// One field: the whole of it must be a finite decimal number.
double number_of(std::string_view field, std::string_view name, const std::string& where) {
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
        throw InputError(fmt::format("{}: {} is {}; write a finite decimal number without spaces",
                                     where, name, base::printable(field)));
    }
    if (std::abs(value) > kMaxMagnitude) {
        throw InputError(
            fmt::format("{}: {} is {}, which is out of range; write a number between "
                        "-1e9 and 1e9",
                        where, name, base::printable(field)));
    }
    return value;
}

RecordedPlace parse_row(std::string_view row, std::size_t frame, const std::string& where) {
    std::string_view fields[7];
    std::size_t count = 0;
    for (std::string_view rest = row;; ++count) {
        const std::size_t comma = rest.find(',');
        if (count < 7) fields[count] = rest.substr(0, comma);
        if (comma == std::string_view::npos) break;
        rest.remove_prefix(comma + 1);
    }
    if (++count != 7) {
        throw InputError(fmt::format("{}: the row {} has {} fields; write seven: {}", where,
                                     base::printable(row), count, kHeader));
    }
    double values[7];
    for (std::size_t i = 0; i < 7; ++i) values[i] = number_of(fields[i], kNames[i], where);
    if (values[0] != double(frame)) {
        throw InputError(
            fmt::format("{}: frame is {} where {} was expected; number the rows 0, 1, "
                        "2, ... without gaps",
                        where, base::printable(fields[0]), frame));
    }
    return {{values[1], values[2], values[3]}, {values[4], values[5], values[6]}};
}

}  // namespace

std::vector<RecordedPlace> parse_recorded(std::string_view text,
                                          const std::filesystem::path& file) {
    std::vector<RecordedPlace> places;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t newline = text.find('\n');
        std::string_view row = text.substr(0, newline);
        text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
        if (row.ends_with('\r')) row.remove_suffix(1);
        const std::string where = fmt::format("{}:{}", file.string(), line);
        if (line > 1) {
            places.push_back(parse_row(row, places.size(), where));
        } else if (row != kHeader) {
            throw InputError(fmt::format("{}: the header is {}; the first line must be {}", where,
                                         base::printable(row), kHeader));
        }
    }
    if (places.empty()) {
        throw InputError(
            fmt::format("{}:1: the recorded flight has no frames; write the header {} "
                        "and one row a frame",
                        file.string(), kHeader));
    }
    return places;
}

std::vector<RecordedPlace> load_recorded(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        throw InputError(
            fmt::format("{}: the recorded flight is not a file that can be read; check "
                        "the path",
                        file.string()));
    }
    if (std::filesystem::file_size(file, error) > kMaxBytes || error) {
        throw InputError(fmt::format("{}: the recorded flight is larger than {} bytes; split it",
                                     file.string(), kMaxBytes));
    }
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) {
        throw InputError(fmt::format(
            "{}: the recorded flight cannot be read; check its permissions", file.string()));
    }
    return parse_recorded(text.view(), file);
}

}  // namespace lodbench::scenario
