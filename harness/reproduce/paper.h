#pragma once
// A paper as data: what was flown, what was published, what is claimed. Read from TOML;
// scenarios/README.md lists every key.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reproduce/interval.h"
#include "results/folder.h"
#include "results/match.h"
#include "results/number_fields.h"
#include "scenario/scenario.h"

namespace lodbench::reproduce {

/// Which cells are meant. What is empty says nothing about them.
struct Selection {
    std::string experiment, scenario, method;
    std::map<std::string, std::string> params;  ///< values as text; "": any, whatever others say

    /// With what `other` says where this says nothing.
    [[nodiscard]] Selection completed_by(const Selection& other) const;
    [[nodiscard]] bool empty() const;
    /// "pgm, fetches=1, grid=600"
    [[nodiscard]] std::string words() const;
};

/// A cell, and its frames where they are kept.
struct CellWithFrames {
    const results::CellRecord* cell = nullptr;
    const results::FrameTable* frames = nullptr;
};

/// A figure of a cell: one field, or a product and quotient of several, "fps * triangles.mean".
struct Figure {
    struct Factor {
        std::string name;
        bool is_time = false;
        bool divides = false;
        std::function<std::optional<double>(const CellWithFrames&)> read;
    };
    std::string text;
    std::vector<Factor> factors;

    /// Nothing where one of the fields was not measured.
    [[nodiscard]] std::optional<double> of(const CellWithFrames& cell) const;
    [[nodiscard]] bool is_time() const;
};

/// A figure of certain cells.
struct Quantity {
    Figure figure;
    Selection selection;
};

struct Experiment {
    std::string id, did;  ///< what the paper did, in words
    std::vector<std::filesystem::path> scenarios;
    scenario::Overrides overrides, quick;  ///< always; with --quick, after those
    bool keeps_terrain = false;            ///< --terrain does not change it
    /// Each method's knob is searched for it.
    std::optional<results::MatchTarget> match;
    int most_probes = 12;
    std::string where;
};

/// Figures that a paper published, as it printed them.
struct Table {
    struct Column {
        std::string title, unit;
        Figure figure;  ///< what of our cells stands beside it
        Selection selection;
    };
    struct Row {
        std::string title;
        Selection selection;
        std::vector<std::optional<double>> values;  ///< one a column; nothing: not published
    };
    std::string id, title, rows_are;
    Selection selection;
    std::vector<Column> columns;
    std::vector<Row> rows;
    /// Whose cells all others are divided by: this column's in each row, this row's in each column,
    /// or, with both, one cell.
    std::optional<std::size_t> baseline_column, baseline_row;
    std::string where;

    /// Row and column of what a cell is divided by; nothing where there is no baseline.
    [[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> baseline_of(
        std::size_t row, std::size_t column) const;
};

/// Curves along a flight, as a paper draws them.
struct LineFigure {
    struct Curve {
        std::string title;
        Selection selection;
        /// Part of the flight, 0 to 1 and rising, and value; empty where no number is printed.
        std::vector<std::pair<double, double>> points;
    };
    std::string id, title, unit;
    std::string column;  ///< of frames: "wall_ms", "triangles", ..., or "fps", of wall_ms
    Selection selection;
    std::vector<Curve> curves;
    std::size_t baseline = 0;  ///< the curve by whose mean all are divided
    std::string where;

    [[nodiscard]] bool of_rate() const { return column == "fps"; }
};

/// A predicate over results.
struct Test {
    enum class Kind {
        bound,           ///< `of` lies within `range`
        ratio,           ///< `of` / `to` does
        constant,        ///< the greatest / the least of `of` over `over` is at most `within`;
                         ///< of `of` / `to`, here and in the next two, where there is a `to`
        rises,           ///< `of` does, from each of `over` to the next
        falls,           ///< likewise
        rank,            ///< rank correlation of `of` and `to` over `over` lies within `range`
        published,       ///< each cell of `table` over its baseline is that of the paper, by a
                         ///< factor of `within`
        published_rank,  ///< rank correlation of all cells of `table` with the paper's is in
                         ///< `range`
    };
    Kind kind = Kind::bound;
    std::string words;
    std::optional<Quantity> of, to;
    Range range;
    double within = 0;
    bool strictly = false;
    std::vector<Selection> for_each, over;
    std::string table;
    std::string where;
};
[[nodiscard]] const char* name_of(Test::Kind kind);

/// One way to read what a paper leaves open: claims are judged in each.
struct Reading {
    std::string name;
    Selection selection;
};

/// Why a claim may not hold, to be seen in flights that the claim itself does not ask for: with one
/// thing changed.
struct Explanation {
    std::string words;
    std::optional<Selection> selection;  ///< in the place of the claim's
    std::vector<Test> tests;             ///< all are to hold
    std::string where;
};

struct Claim {
    std::string id, words, place;
    Selection selection;
    std::vector<Reading> readings;          ///< at least one; the only one may be without a name
    std::vector<Test> tests;                ///< all are to hold
    std::vector<Explanation> explanations;  ///< of these any
    /// Why nothing here can judge it; "" where tests do.
    std::string unjudged;
    bool needs_gpu = false;      ///< is about times of a GPU
    bool needs_terrain = false;  ///< is about the paper's own terrain
    std::string where;
};

/// The terrain that the paper flew over: how a file of it, which the user has, is to be read.
struct OwnTerrain {
    std::string name;
    std::string keys;  ///< of [terrain], inline: ", spacing = 10, vertical_scale = 0.1"

    /// The table [terrain] of a scenario that flies over such a file.
    [[nodiscard]] std::string table_of(const std::filesystem::path& terrain_file) const;
};

struct Paper {
    std::filesystem::path file;
    std::string id;  ///< the file's stem
    std::string title, citation, hardware;
    std::vector<std::string> errata;
    OwnTerrain terrain;
    scenario::Overrides quick;  ///< with --quick, of all experiments
    std::vector<Experiment> experiments;
    std::vector<Table> tables;
    std::vector<LineFigure> figures;
    std::vector<Claim> claims;

    /// nullptr where there is none of that id.
    [[nodiscard]] const Experiment* experiment(const std::string& name) const;
    [[nodiscard]] const Table* table(const std::string& name) const;
};

/// Throws InputError as "FILE:LINE: what is wrong with VALUE; remedy", also for a figure that is no
/// field of a cell, an experiment or a table that is not there, and a key that is not known.
[[nodiscard]] Paper read_paper(const std::filesystem::path& file);

/// Columns of single frames that are kept (results/folder.h).
[[nodiscard]] const std::vector<std::string>& frame_columns();

/// "fps * triangles.mean / frames". "frames.triangles@0.5" is of the frame halfway along the
/// flight, by the columns of its CSV that are kept (results/folder.h). Throws InputError that
/// begins with `where`.
[[nodiscard]] Figure parse_figure(const std::string& text, const std::string& where);

}  // namespace lodbench::reproduce
