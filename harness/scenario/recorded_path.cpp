#include "scenario/recorded_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "api/error.h"
#include "base/printable.h"

namespace lodbench::scenario {
namespace {

constexpr std::string_view kHeader = "frame,x,y,z,heading,pitch,roll";
constexpr std::string_view kNames[7] = {"frame", "x", "y", "z", "heading", "pitch", "roll"};
constexpr std::uintmax_t kMaxBytes = 256ULL << 20U;
constexpr double kMaxMagnitude = 1e9;  // metres; beyond it a double no longer resolves a micrometre

using Fields = std::vector<std::string_view>;

/// Without blanks around it, and without the quotes that some programs put around every field.
std::string_view bare(std::string_view field) {
    const auto trim = [&field] {
        const std::size_t first = std::min(field.find_first_not_of(" \t"), field.size());
        field = field.substr(first, field.find_last_not_of(" \t") + 1 - first);
    };
    trim();
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
        field = field.substr(1, field.size() - 2);
        trim();
    }
    return field;
}

/// A separator in quotes belongs to its field.
Fields split(std::string_view row, char separator) {
    Fields fields;
    bool quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= row.size(); ++i) {
        if (i < row.size() && row[i] == '"') quoted = !quoted;
        if (i < row.size() && (quoted || row[i] != separator)) continue;
        fields.push_back(bare(row.substr(begin, i - begin)));
        begin = i + 1;
    }
    return fields;
}

bool is_header(const Fields& fields) {
    return std::ranges::equal(fields, kNames);
}

/// Takes a line and what ends it, LF, CRLF or CR, from the text.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (text.starts_with("\r\n")) {
        text.remove_prefix(2);
    } else if (!text.empty()) {
        text.remove_prefix(1);
    }
    return line;
}

class RecordedText {
public:
    explicit RecordedText(const std::filesystem::path& file) : file_(base::plain(file.string())) {}

    std::vector<RecordedPlace> parse(std::string_view text) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
            refuse("the file is UTF-16; save it as CSV in UTF-8");
        }
        if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
        std::vector<RecordedPlace> places;
        if (!text.empty()) read_header(take_line(text));
        int empty_line = 0;  // the first of those before this line
        while (!text.empty()) {
            ++line_;
            const std::string_view row = take_line(text);
            if (bare(row).empty()) {
                if (empty_line == 0) empty_line = line_;
                continue;
            }
            if (empty_line > 0) {
                line_ = empty_line;
                refuse("an empty line between the rows; remove it");
            }
            places.push_back(parse_row(row, places.size()));
        }
        if (places.empty()) {
            line_ = 1;
            refuse(
                fmt::format("the recorded flight has no frames; write the header {} and one "
                            "row a frame",
                            kHeader));
        }
        return places;
    }

private:
    [[noreturn]] void refuse(const std::string& message) const {
        throw InputError(fmt::format("{}:{}: {}", file_, line_, message));
    }

    void read_header(std::string_view row) {
        for (const char separator : {',', ';', '\t'}) {
            separator_ = separator;
            const Fields fields = split(row, separator);
            if (is_header(fields)) return;
            double number = 0;
            const auto is_number = [&number](std::string_view field) {
                return std::from_chars(field.data(), field.data() + field.size(), number).ec ==
                       std::errc();
            };
            if (fields.size() == std::size(kNames) && std::ranges::all_of(fields, is_number)) {
                refuse(
                    fmt::format("the header is missing, the first line is the row {}; put {} "
                                "above it",
                                base::printable(row), kHeader));
            }
        }
        refuse(fmt::format("the header is {}; the first line must be {}", base::printable(row),
                           kHeader));
    }

    RecordedPlace parse_row(std::string_view row, std::size_t frame) {
        const Fields fields = split(row, separator_);
        if (fields.size() != std::size(kNames)) {
            const bool commas = separator_ == ',' && fields.size() > std::size(kNames);
            refuse(fmt::format(
                "the row {} has {} fields; write seven: {}{}", base::printable(row), fields.size(),
                kHeader, commas ? "; decimal commas need semicolons between the fields" : ""));
        }
        double values[std::size(kNames)];
        for (std::size_t i = 0; i < fields.size(); ++i) values[i] = number_of(fields[i], kNames[i]);
        if (values[0] != double(frame)) {
            refuse(
                fmt::format("frame is {} where {} was expected; number the rows 0, 1, 2, ... "
                            "without gaps",
                            base::printable(fields[0]), frame));
        }
        return {{values[1], values[2], values[3]}, {values[4], values[5], values[6]}};
    }

    /// One field: the whole of it must be a finite decimal number.
    double number_of(std::string_view field, std::string_view name) {
        std::string digits(field);
        note_decimal_mark(field, name);
        if (decimal_mark_ == ',') std::ranges::replace(digits, ',', '.');
        if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.erase(0, 1);
        double value = 0;
        const char* const last = digits.data() + digits.size();
        const auto [end, error] = std::from_chars(digits.data(), last, value);
        if (error != std::errc() || end != last || !std::isfinite(value)) {
            refuse(fmt::format("{} is {}; write a finite decimal number", name,
                               base::printable(field)));
        }
        if (std::abs(value) > kMaxMagnitude) {
            refuse(
                fmt::format("{} is {}, which is out of range; write a number between -1e9 and "
                            "1e9",
                            name, base::printable(field)));
        }
        return value;
    }

    /// The first mark decides for the file: where both are there, one of them may part thousands,
    /// and "1,234" cannot be read.
    void note_decimal_mark(std::string_view field, std::string_view name) {
        const std::size_t at = field.find_first_of(".,");
        if (at == std::string_view::npos) return;
        if (decimal_mark_ == 0) {
            decimal_mark_ = separator_ == ',' ? '.' : field[at];
            mark_line_ = line_;
        }
        const char other = decimal_mark_ == '.' ? ',' : '.';
        if (field.find(other) == std::string_view::npos) return;
        refuse(
            fmt::format("{} is {}, with a '{}' where line {} has '{}' as the decimal mark; "
                        "write one of the two throughout, and none between thousands",
                        name, base::printable(field), other, mark_line_, decimal_mark_));
    }

    std::string file_;
    int line_ = 1;
    char separator_ = ',';
    char decimal_mark_ = 0;  // until there is one
    int mark_line_ = 0;
};

}  // namespace

std::vector<RecordedPlace> parse_recorded(std::string_view text,
                                          const std::filesystem::path& file) {
    return RecordedText(file).parse(text);
}

std::string recorded_csv(std::span<const RecordedPlace> places) {
    std::string text = fmt::format("{}\n", kHeader);
    for (std::size_t frame = 0; frame < places.size(); ++frame) {
        text += fmt::format("{}", frame);
        const RecordedPlace& place = places[frame];
        for (const glm::dvec3& part : {place.position, place.angles}) {
            for (const double value : {part.x, part.y, part.z}) {
                if (!(std::abs(value) <= kMaxMagnitude)) {
                    throw InputError(fmt::format(
                        "frame {} of the flight has the number {}, which a recorded flight cannot "
                        "have: between -1e9 and 1e9 are",
                        frame, value));
                }
                text += fmt::format(",{}", value);
            }
        }
        text += '\n';
    }
    return text;
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
