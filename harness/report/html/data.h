#pragma once
// What the sections of a report are made from: the folders, and in them the cells of each scenario.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "measure/statistics.h"
#include "results/cell_groups.h"
#include "results/folder.h"

namespace lodbench::report::html {

// What a page holds at most, so that a report of thousands of cells opens as well; the page says
// what it left out.
inline constexpr std::size_t kMostPlottedSets = 12;
inline constexpr std::size_t kMostCurves = 16;  ///< of one plot
inline constexpr std::size_t kMostBars = 24;    ///< categories of one plot
inline constexpr std::size_t kMostCurvePoints = 240;
inline constexpr std::size_t kMostRows = 400;            ///< of all tables but summary and cells
inline constexpr std::size_t kPictureBytes = 3'000'000;  ///< of all pictures together, as text

/// One scenario of one folder on one device: the comparison that its numbers allow.
struct ResultSet {
    const results::ResultFolder* folder = nullptr;
    std::string scenario;
    std::string device;  ///< "" where all of the folder was flown on one
    std::string title;   ///< with the folder's name where there are several
    std::string id;      ///< of the page's elements
    std::vector<results::CellGroup> groups;
    const results::FlightRecord* flight = nullptr;
    std::uint64_t seed = 1;  ///< of the bootstrap
    bool plotted = true;
};

struct ReportData {
    const std::vector<results::ResultFolder>* folders = nullptr;
    std::vector<ResultSet> sets;
    std::map<std::string, std::size_t> colors;  ///< of each method, the same on the whole page
    [[nodiscard]] std::size_t color_of(const results::CellGroup& group) const {
        return colors.at(group.method);
    }
};

/// The folders must outlive it.
[[nodiscard]] ReportData arrange(const std::vector<results::ResultFolder>& folders);

/// A figure of a group: the median over its repetitions, as in summary.md.
[[nodiscard]] std::optional<double> figure(const results::CellGroup& group,
                                           const results::CellFigure& figure);
/// Whether a setting of the set has it.
[[nodiscard]] bool any_has(const ResultSet& set, const results::CellFigure& figure);
/// Over the repetitions; nothing where one is not finite.
[[nodiscard]] std::optional<measure::RunInterval> interval(const results::CellGroup& group,
                                                           std::uint64_t seed,
                                                           const results::CellFigure& figure);

/// A column of the frames, per frame the median over the repetitions; NaN where it is absent. Empty
/// where no repetition has it.
[[nodiscard]] std::vector<double> frame_column(const ResultSet& set,
                                               const results::CellGroup& group, const char* column);

/// Indices of at most `most` groups that are ok somewhere, in their order: first one setting of
/// each method, then a second, ...
[[nodiscard]] std::vector<std::size_t> choose_groups(const ResultSet& set, std::size_t most);

/// How many settings of its method come before it.
[[nodiscard]] std::size_t variant_of(const ResultSet& set, std::size_t group);

/// "" or that some of the settings are not drawn.
[[nodiscard]] std::string left_out_note(const ResultSet& set, std::size_t drawn);

}  // namespace lodbench::report::html
