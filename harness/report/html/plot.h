#pragma once
// A plot of the report: one description, from which come its SVGs and the values that the script
// tells.

#include <json/value.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lodbench::report::html {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// A point of a curve, or a bar: then `x` is its value and `y` the index of its category.
struct Mark {
    double x = 0;
    double y = 0;
    double low = kAbsent;  ///< of a bar: its interval
    double high = kAbsent;
    std::string label = {};  ///< what it is of, where the series does not say
    std::string value = {};  ///< what is written beside the point
    bool ringed = false;     ///< on the Pareto front, or what was taken
};

inline constexpr std::size_t kColors = 12;  ///< of the page's style: --c0, --c1, ...

/// What has one colour and one dash. Colours and dashes repeat where there are more than the page
/// has.
struct Series {
    std::string name;
    std::string toggle = {};  ///< the method with which it is shown and hidden; "": always shown
    std::size_t color = 0;
    std::size_t variant = 0;  ///< of a curve its dash, of bars how faint they are
    bool ink = false;         ///< the text's colour instead
    bool joined = true;       ///< by a line
    bool dots = true;
    std::vector<Mark> marks = {};
};

struct Category {
    std::string label;
    std::string toggle;
    std::size_t color = 0;
};

struct Plot {
    enum class Kind { curves, bars };
    Kind kind = Kind::curves;
    std::string id;  ///< of one page
    std::string title;
    std::string x_title, y_title;  ///< with units
    bool counts = false;  ///< x is a number of something: that axis is linear, its ticks whole
    bool from_zero =
        true;  ///< else a linear y spans the values alone, so that a small change shows
    bool can_be_logarithmic = false;
    bool logarithmic =
        false;  ///< as it is drawn at first, both axes; of bars the one that they have
    std::vector<Series> series;
    std::vector<Category> categories = {};  ///< of bars
    std::optional<double> reference = {};   ///< of bars: a line across them
    std::vector<std::string> notes = {};    ///< what was left out, and the like
};

/// Whether anything in it can be drawn.
[[nodiscard]] bool has_marks(const Plot& plot);

/// Marks in order of x, at most `most` (>= 4) of them: of each of most / 2 stretches the least and
/// the greatest, so that no peak is lost. Marks that are not finite are dropped.
[[nodiscard]] std::vector<Mark> thinned(const std::vector<Mark>& marks, std::size_t most);

/// A figure with its caption and its SVGs; "" where there is nothing to draw.
[[nodiscard]] std::string to_html(const Plot& plot);

/// For the script: what stands where, exactly.
[[nodiscard]] Json::Value to_json(const Plot& plot);

/// A stroke of the series' colour and dash, for legends.
[[nodiscard]] std::string key_html(const Series& series);

/// The class attribute's words for its colour.
[[nodiscard]] std::string color_class(std::size_t color);

}  // namespace lodbench::report::html
