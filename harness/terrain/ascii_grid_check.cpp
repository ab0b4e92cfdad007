#include "terrain/ascii_grid_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/error.h"
#include "base/printable.h"
#include "terrain/raster_reader.h"

namespace lodbench::terrain {
namespace {

constexpr std::array<std::string_view, 10> kKeys = {
    "ncols",     "nrows",    "xllcorner", "yllcorner", "xllcenter",
    "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};

constexpr std::size_t kMostHeaderBytes = 4096;
constexpr std::size_t kLongestCell = 64;

bool blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

/// A number as GDAL reads it, or nothing. NaN and infinity have words of their own, those of old
/// Windows libraries among them.
std::optional<double> number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    if (text.starts_with("1.#") || text.starts_with("-1.#")) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

class Checker {
public:
    explicit Checker(const std::filesystem::path& file)
        : file_(file), stream_(file, std::ios::binary) {}

    AsciiGrid check() {
        head_.resize(kMostHeaderBytes);
        stream_.read(head_.data(), std::streamsize(head_.size()));
        head_.resize(std::size_t(stream_.gcount()));
        refuse_encodings();
        const std::size_t first = std::min(head_.find_first_not_of(" \t\r\n"), head_.size());
        if (!known(lower(head_.substr(first, head_.find_first_of(" \t\r\n", first) - first)))) {
            return {};
        }
        const std::size_t cells = read_header();
        check_keys();
        check_raster_size(file_, grid_.rows, grid_.columns);
        read_cells(cells);
        return grid_;
    }

private:
    template <typename... Values>
    [[noreturn]] void refuse(fmt::format_string<Values...> form, Values&&... values) const {
        throw InputError(fmt::format("{}: {}", file_.string(),
                                     fmt::format(form, std::forward<Values>(values)...)));
    }

    static bool known(std::string_view key) { return std::ranges::find(kKeys, key) != kKeys.end(); }

    void refuse_encodings() const {
        if (head_.starts_with("\xEF\xBB\xBF")) {
            refuse(
                "begins with a byte order mark of UTF-8; save the grid as plain text without one");
        }
        if (head_.starts_with("\xFF\xFE") || head_.starts_with("\xFE\xFF") ||
            (head_.size() > 1 && (head_[0] == '\0') != (head_[1] == '\0'))) {
            refuse(
                "is text of UTF-16; save the grid as plain text (ASCII or UTF-8 without a mark)");
        }
    }

    /// Returns where the cells begin.
    std::size_t read_header() {
        std::size_t begin = 0;
        for (int line = 1; begin < head_.size(); ++line) {
            const std::size_t end = std::min(head_.find('\n', begin), head_.size());
            std::string_view text(head_.data() + begin, end - begin);
            if (text.ends_with('\r')) text.remove_suffix(1);
            const std::size_t first = text.find_first_not_of(" \t");
            if (first != std::string_view::npos &&
                std::isalpha(static_cast<unsigned char>(text[first])) == 0) {
                return begin;
            }
            if (first != std::string_view::npos &&
                number(text.substr(first, text.find_first_of(" \t", first) - first))) {
                return begin;  // "nan": a cell
            }
            if (text.find('\r') != std::string_view::npos) {
                refuse("line {}: lines end in a carriage return alone; end them in line feeds",
                       line);
            }
            if (first == std::string_view::npos)
                refuse("line {}: an empty line in the header", line);
            read_header_line(text, first, line);
            begin = end + 1;
        }
        refuse("ends in its header; it is truncated, fetch it anew");
    }

    void read_header_line(std::string_view text, std::size_t first, int line) {
        const std::size_t key_end = std::min(text.find_first_of(" \t", first), text.size());
        const std::string key = lower(text.substr(first, key_end - first));
        if (!known(key)) {
            refuse("line {}: {} is neither a number nor a key of the header; known: {}", line,
                   base::printable(text.substr(first, key_end - first)), fmt::join(kKeys, ", "));
        }
        if (first > 0) {
            refuse("line {}: {} is indented; begin header lines in the first column", line, key);
        }
        const std::size_t begin = std::min(text.find_first_not_of(" \t", key_end), text.size());
        const std::size_t end = text.find_last_not_of(" \t") + 1;
        const std::string_view value = text.substr(begin, std::max(end, begin) - begin);
        const std::optional<double> found = number(value);
        if (!found) {
            refuse("line {}: {} is {}; expected one number", line, key, base::printable(value));
        }
        if (!values_.emplace(key, *found).second) {
            refuse("line {}: {} is given twice; give it once", line, key);
        }
    }

    [[nodiscard]] std::int64_t whole(const char* key) const {
        const auto found = values_.find(key);
        if (found == values_.end()) refuse("the header has no {}; add it", key);
        if (!(found->second >= 1 && found->second < 1e15) ||
            found->second != std::floor(found->second)) {
            refuse("{} is {}; expected a whole number", key, found->second);
        }
        return std::int64_t(found->second);
    }

    void check_keys() {
        grid_.recognised = true;
        grid_.rows = whole("nrows");
        grid_.columns = whole("ncols");
        const auto given = [this](const char* key) { return values_.contains(key); };
        if (!given("cellsize") && !(given("dx") && given("dy"))) {
            refuse("the header has no cellsize; add it");
        }
        for (const char* axis : {"xll", "yll"}) {
            const std::string name(axis);
            if (!values_.contains(name + "corner") && !values_.contains(name + "center")) {
                refuse("the header has neither {0}corner nor {0}center; add one", name);
            }
        }
    }

    void read_cells(std::size_t begin) {
        stream_.clear();
        stream_.seekg(std::streamoff(begin));
        std::vector<char> buffer(std::size_t{1} << 20U);
        std::string cell;  // may lie across two pieces
        do {
            stream_.read(buffer.data(), std::streamsize(buffer.size()));
            const auto count = std::size_t(stream_.gcount());
            std::size_t at = 0;
            while (at < count) {
                const std::size_t start = at;
                while (at < count && !blank(buffer[at])) ++at;
                const std::string_view part(buffer.data() + start, at - start);
                if (at == count || !cell.empty()) {
                    cell.append(part.substr(0, kLongestCell + 1));
                    if (at < count) take(cell);
                    if (at < count) cell.clear();
                } else if (!part.empty()) {
                    take(part);
                }
                while (at < count && blank(buffer[at])) ++at;
            }
        } while (stream_);
        if (!cell.empty()) take(cell);
        if (cells_ < grid_.rows * grid_.columns) {
            refuse(
                "ends after {} cells, but {} rows x {} columns make {}; it is truncated, fetch it "
                "anew",
                cells_, grid_.rows, grid_.columns, grid_.rows * grid_.columns);
        }
    }

    void take(std::string_view cell) {
        const std::int64_t row = cells_ / grid_.columns;
        if (row >= grid_.rows) {
            refuse(
                "more cells than the {} rows x {} columns of its header; correct nrows and ncols",
                grid_.rows, grid_.columns);
        }
        const std::optional<double> value =
            cell.size() > kLongestCell ? std::nullopt : number(cell);
        if (!value) {
            refuse(
                "the cell at row {}, column {} is {}, which is no number; write one with a decimal "
                "point, or the no-data value",
                row, cells_ % grid_.columns, base::printable(cell));
        }
        ++cells_;
        if (grid_.fractional) return;
        const bool as_it_is = std::abs(*value) <= std::numeric_limits<std::int32_t>::max() &&
                              cell.find_first_of(".eEnN") == std::string_view::npos;
        grid_.fractional = !as_it_is;
    }

    const std::filesystem::path& file_;
    std::ifstream stream_;
    std::string head_;
    std::map<std::string, double, std::less<>> values_;
    AsciiGrid grid_;
    std::int64_t cells_ = 0;
};

}  // namespace

AsciiGrid check_ascii_grid(const std::filesystem::path& file) {
    return Checker(file).check();
}

}  // namespace lodbench::terrain
