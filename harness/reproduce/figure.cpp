// Figures of a cell, as a paper's file writes them: "fps * triangles.mean".

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "api/error.h"
#include "base/printable.h"
#include "reproduce/paper.h"
#include "scenario/toml_section.h"

namespace lodbench::reproduce {

using scenario::Section;

namespace {

constexpr std::string_view kFrames = "frames.";

/// "frames.triangles@0.5". Throws InputError.
Figure::Factor read_frame_factor(const std::string& word, const std::string& where) {
    const std::size_t at = word.find('@');
    const std::string column = word.substr(kFrames.size(), at - kFrames.size());
    double part = -1;
    const char* const end = word.data() + word.size();
    const bool known = std::ranges::find(frame_columns(), column) != frame_columns().end();
    const auto read = at == word.npos ? std::from_chars_result{end, std::errc::invalid_argument}
                                      : std::from_chars(word.data() + at + 1, end, part);
    if (!known || read.ec != std::errc() || read.ptr != end || !(part >= 0 && part <= 1)) {
        throw InputError(fmt::format(
            "{}: {} is no figure of a frame; write frames.COLUMN@PART with a column of {} and a "
            "part of the flight from 0 to 1",
            where, base::printable(word), fmt::join(frame_columns(), ", ")));
    }
    return {word, column == "wall_ms", false,
            [column, part](const CellWithFrames& cell) -> std::optional<double> {
                const auto* values = cell.frames == nullptr ? nullptr : cell.frames->find(column);
                if (values == nullptr) return std::nullopt;
                const double value =
                    values->at(std::size_t(std::lround(part * double(values->size() - 1))));
                return std::isnan(value) ? std::nullopt : std::optional(value);
            }};
}

Figure::Factor read_factor(const std::string& word, const std::string& where) {
    if (word.starts_with(kFrames)) return read_frame_factor(word, where);
    auto field = results::number_field(word);
    if (!field) {
        throw InputError(fmt::format(
            "{}: {} is no number of a cell; {}, counters.NAME, params.NAME, frames.COLUMN@PART",
            where, base::printable(word),
            Section::known_names(word, results::number_field_names())));
    }
    return {word, field->is_time(), false,
            [read = field->read](const CellWithFrames& cell) { return read(*cell.cell); }};
}

}  // namespace

const std::vector<std::string>& frame_columns() {
    static const std::vector<std::string> columns = {"wall_ms", "triangles", "pixel_p999_px",
                                                     "popping_p999_px"};
    return columns;
}

std::optional<double> Figure::of(const CellWithFrames& cell) const {
    double product = 1;
    for (const Factor& factor : factors) {
        const auto value = factor.read(cell);
        if (!value || (factor.divides && *value == 0)) return std::nullopt;
        product = factor.divides ? product / *value : product * *value;
    }
    return product;
}

bool Figure::is_time() const {
    return std::ranges::any_of(factors, &Factor::is_time);
}

Figure parse_figure(const std::string& text, const std::string& where) {
    Figure figure;
    figure.text = text;
    bool divides = false;
    bool expects_field = true;
    std::istringstream words(text);
    for (std::string word; words >> word; expects_field = !expects_field) {
        if (!expects_field) {
            if (word != "*" && word != "/") {
                throw InputError(fmt::format("{}: {} in {}: fields are joined by * and /", where,
                                             base::printable(word), base::printable(text)));
            }
            divides = word == "/";
            continue;
        }
        figure.factors.push_back(read_factor(word, where));
        figure.factors.back().divides = divides;
    }
    if (expects_field) {
        throw InputError(fmt::format("{}: {} ends without a field; write one, as frame_ms.median",
                                     where, base::printable(text)));
    }
    return figure;
}

}  // namespace lodbench::reproduce
