// A paper's file: TOML that a stranger may have written, read key by key.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "api/error.h"
#include "base/printable.h"
#include "reproduce/paper.h"
#include "scenario/flight_section.h"
#include "scenario/overrides_section.h"
#include "scenario/toml_section.h"
#include "terrain/toml_file.h"

namespace lodbench::reproduce {

namespace fs = std::filesystem;
using scenario::Limits;
using scenario::read_overrides;
using scenario::Section;
using scenario::toml_text;

namespace {

constexpr const char* kKind = "a paper";
constexpr std::size_t kMostSelections = 1000;

std::string required_text(Section& section, std::string_view key, const std::string& what) {
    auto text = section.text(key);
    if (!text) section.require(key, "write " + what);
    return *text;
}

/// A name that can stand in a file's name.
std::string read_id(Section& section, const std::set<std::string>& taken) {
    std::string id = required_text(section, "id", "a short name");
    const bool plain = id.size() <= 64 && std::ranges::all_of(id, [](char c) {
                           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                  (c >= '0' && c <= '9') || c == '-' || c == '_';
                       });
    if (!plain) section.refuse("id", "ids are 1 to 64 of A-Z a-z 0-9 _ -");
    if (taken.contains(id)) section.refuse("id", "there twice; give it another id");
    return id;
}

std::vector<std::string> texts(Section& section, std::string_view key) {
    std::vector<std::string> values;
    const toml::node* node = section.node(key);
    if (node == nullptr) return values;
    const toml::array* array = node->as_array();
    const bool good = array != nullptr && std::ranges::all_of(*array, [](const toml::node& entry) {
                          return entry.is_string() && !entry.as_string()->get().empty();
                      });
    if (!good) section.refuse(key, "write a list of texts");
    for (const toml::node& entry : *array) values.push_back(entry.as_string()->get());
    return values;
}

// ---- selections --------------------------------------------------------------------------------

std::string param_text(const Section& section, std::string_view key, const toml::node& node) {
    if (const auto* text = node.as_string()) {
        return text->get();
    } else if (node.is_number() || node.is_boolean()) {
        return scenario::describe(node);
    }
    section.refuse(key, "write a number, true or false, or text; \"\" is any value");
}

void set_key(Selection& selection, std::string_view key, std::string value) {
    if (key == "experiment") {
        selection.experiment = std::move(value);
    } else if (key == "scenario") {
        selection.scenario = std::move(value);
    } else if (key == "method") {
        selection.method = std::move(value);
    } else {
        selection.params[std::string(key)] = std::move(value);
    }
}

/// Each key that is not in `others`: a selection's, or a parameter.
Selection read_keys(Section& section, const std::set<std::string_view>& others) {
    Selection selection;
    for (const auto& [key, node] : section.table()) {
        (void)section.node(key.str());
        if (others.contains(key.str())) continue;
        set_key(selection, key.str(), param_text(section, key.str(), node));
    }
    return selection;
}

Selection read_selection(Section& section, std::string_view key) {
    auto table = section.section(key);
    return table ? read_keys(*table, {}) : Selection();
}

/// A table of lists is every combination of one value each, the last key's fastest.
void add_combinations(Section& table, std::vector<Selection>& selections) {
    std::vector<Selection> result(1);
    for (const auto& [key, node] : table.table()) {
        std::vector<Selection> longer;
        const auto add = [&](const toml::node& value) {
            for (const Selection& selection : result) {
                longer.push_back(selection);
                set_key(longer.back(), key.str(), param_text(table, key.str(), value));
            }
        };
        if (const toml::array* list = node.as_array()) {
            for (const toml::node& value : *list) add(value);
        } else {
            add(node);
        }
        if (longer.empty() || longer.size() + selections.size() > kMostSelections) {
            table.refuse(key.str(), fmt::format("write 1 to {} values", kMostSelections));
        }
        result = std::move(longer);
    }
    selections.insert(selections.end(), result.begin(), result.end());
}

/// The rows of a table by its id, one table of lists, or several.
std::vector<Selection> read_selections(Section& section, std::string_view key, const Paper& paper) {
    std::vector<Selection> selections;
    const toml::node* node = section.node(key);
    if (node == nullptr) return selections;
    if (const auto* id = node->as_string()) {
        const Table* table = paper.table(id->get());
        if (table == nullptr) section.refuse(key, "no [[table]] of this id stands above");
        for (const Table::Row& row : table->rows) selections.push_back(row.selection);
    } else if (node->is_table()) {
        Section table = *section.section(key);
        add_combinations(table, selections);
    } else {
        for (Section& table : section.sections(key)) add_combinations(table, selections);
    }
    return selections;
}

// ---- experiments and tables --------------------------------------------------------------------

std::optional<results::MatchTarget> read_match(Section& experiment) {
    auto section = experiment.section("match");
    if (!section) return std::nullopt;
    using Quantity = results::MatchTarget::Quantity;
    results::MatchTarget target;
    const auto error = section->number("error_px", {1e-6, 1e6});
    const auto triangles = section->number("triangles", {1, 1e12});
    if (error.has_value() == triangles.has_value()) {
        section->require("error_px", "write one of error_px = PX and triangles = N");
    }
    if (triangles) target.quantity = Quantity::triangles;
    target.value = error ? *error : *triangles;
    target.tolerance = section->number("tolerance", {1e-4, 0.5}).value_or(target.tolerance);
    if (const auto name = section->text("metric")) {
        const auto metric = results::error_metric(*name);
        if (!metric) section->refuse("metric", "write p999, max or rms");
        target.metric = *metric;
    }
    section->refuse_unknown(kKind);
    return target;
}

Experiment read_experiment(Section& section, const fs::path& folder,
                           const std::set<std::string>& taken) {
    Experiment experiment;
    experiment.where = section.where();
    experiment.id = read_id(section, taken);
    experiment.did = required_text(section, "did", "what the paper did");
    for (const std::string& name : texts(section, "scenarios")) {
        experiment.scenarios.push_back(scenario::existing_file(section, "scenarios", name, folder));
    }
    if (experiment.scenarios.empty()) {
        section.require("scenarios", "write a list of scenario files");
    }
    experiment.overrides = read_overrides(section, "override");
    experiment.quick = read_overrides(section, "quick");
    experiment.keeps_terrain = section.boolean("keeps_terrain").value_or(false);
    experiment.match = read_match(section);
    if (const auto probes = section.integer("probes", 2, 100)) {
        experiment.most_probes = int(*probes);
    }
    if (const auto repetitions = section.integer("repetitions", 1, 1000)) {
        experiment.overrides.set("run.repetitions", fmt::format("{}", *repetitions),
                                 section.where("repetitions"));
    }
    if (const toml::node* methods = section.node("method")) {
        (void)section.sections("method");  // that they are tables; the rest is the scenario's
        toml::array list = *methods->as_array();
        for (toml::node& method : list) method.as_table()->is_inline(true);
        experiment.overrides.set("method", toml_text(list), section.where("method"));
    }
    section.refuse_unknown(kKind);
    return experiment;
}

std::optional<std::size_t> index_of_title(Section& section, std::string_view key,
                                          const std::vector<std::string>& titles) {
    const auto title = section.text(key);
    if (!title) return std::nullopt;
    const auto found = std::ranges::find(titles, *title);
    if (found == titles.end()) {
        section.refuse(key, "no such title in the table; " + Section::known_names(*title, titles));
    }
    return std::size_t(found - titles.begin());
}

Table::Row read_row(Section& section, std::size_t columns) {
    Table::Row row;
    row.title = required_text(section, "title", "what the row is about");
    row.selection = read_selection(section, "select");
    const toml::node* node = section.node("values");
    const toml::array* values = node == nullptr ? nullptr : node->as_array();
    const std::string remedy =
        fmt::format("write a list of {} numbers, one a column; \"-\" is not published", columns);
    if (values == nullptr) section.require("values", remedy);
    if (values->size() != columns) section.refuse("values", remedy);
    for (const toml::node& value : *values) {
        const auto* text = value.as_string();
        const bool absent = text != nullptr && text->get() == "-";
        if (!absent && !value.is_number()) section.refuse("values", remedy);
        row.values.push_back(absent ? std::nullopt
                                    : std::optional(section.number_of("values", value, Limits{})));
    }
    section.refuse_unknown(kKind);
    return row;
}

Table read_table(Section& section, const std::set<std::string>& taken) {
    Table table;
    table.where = section.where();
    table.id = read_id(section, taken);
    table.title = required_text(section, "title", "what the table is");
    table.rows_are = required_text(section, "rows_are", "the head of its first column");
    table.selection = read_selection(section, "select");
    const auto field = section.text("field");
    const auto unit = section.text("unit");
    std::vector<std::string> column_titles, row_titles;
    for (Section& part : section.sections("column")) {
        Table::Column& column = table.columns.emplace_back();
        column.title = required_text(part, "title", "what the column is about");
        column.selection = read_selection(part, "select");
        column.unit = part.text("unit").value_or(unit.value_or(""));
        const auto own = part.text("field");
        if (!own && !field) part.require("field", "write a field of a cell, here or of the table");
        column.figure =
            parse_figure(own ? *own : *field, own ? part.where("field") : section.where("field"));
        part.refuse_unknown(kKind);
        column_titles.push_back(column.title);
    }
    for (Section& part : section.sections("row")) {
        table.rows.push_back(read_row(part, table.columns.size()));
        row_titles.push_back(table.rows.back().title);
    }
    if (table.columns.empty()) section.require("column", "write [[table.column]]");
    if (table.rows.empty()) section.require("row", "write [[table.row]]");
    table.baseline_column = index_of_title(section, "baseline_column", column_titles);
    table.baseline_row = index_of_title(section, "baseline_row", row_titles);
    section.refuse_unknown(kKind);
    return table;
}

/// [[part, value], ...], rising.
std::vector<std::pair<double, double>> read_points(Section& section) {
    std::vector<std::pair<double, double>> points;
    const toml::node* node = section.node("points");
    if (node == nullptr) return points;
    const std::string remedy =
        "write a list of [part of the flight, value], the parts rising from 0 to 1";
    const toml::array* list = node->as_array();
    if (list == nullptr) section.refuse("points", remedy);
    for (const toml::node& entry : *list) {
        const toml::array* pair = entry.as_array();
        if (pair == nullptr || pair->size() != 2) section.refuse("points", remedy);
        const double at = section.number_of("points", (*pair)[0], Limits{0, 1});
        if (!points.empty() && at <= points.back().first) section.refuse("points", remedy);
        points.emplace_back(at, section.number_of("points", (*pair)[1], Limits{}));
    }
    return points;
}

LineFigure read_figure(Section& section, const std::set<std::string>& taken) {
    LineFigure figure;
    figure.where = section.where();
    figure.id = read_id(section, taken);
    figure.title = required_text(section, "title", "what the figure shows");
    figure.unit = section.text("unit").value_or("");
    figure.column = required_text(section, "column", "a column of frames, or fps");
    std::vector<std::string> known = frame_columns();
    known.emplace_back("fps");
    if (std::ranges::find(known, figure.column) == known.end()) {
        section.refuse("column", Section::known_names(figure.column, known));
    }
    figure.selection = read_selection(section, "select");
    std::vector<std::string> titles;
    for (Section& part : section.sections("curve")) {
        figure.curves.push_back({required_text(part, "title", "what the curve is of"),
                                 read_selection(part, "select"), read_points(part)});
        part.refuse_unknown(kKind);
        titles.push_back(figure.curves.back().title);
    }
    if (figure.curves.empty()) section.require("curve", "write [[figure.curve]]");
    const auto baseline = index_of_title(section, "baseline", titles);
    if (!baseline)
        section.require("baseline", "write the title of the curve that all are divided by");
    figure.baseline = *baseline;
    section.refuse_unknown(kKind);
    return figure;
}

// ---- claims ------------------------------------------------------------------------------------

constexpr std::pair<Test::Kind, const char*> kKinds[] = {
    {Test::Kind::bound, "bound"},         {Test::Kind::ratio, "ratio"},
    {Test::Kind::constant, "constant"},   {Test::Kind::rises, "rises"},
    {Test::Kind::falls, "falls"},         {Test::Kind::rank, "rank"},
    {Test::Kind::published, "published"}, {Test::Kind::published_rank, "published-rank"},
};

Test::Kind read_kind(Section& section) {
    const std::string name = required_text(section, "kind", "what is to hold, as \"ratio\"");
    std::vector<std::string> names;
    for (const auto& [kind, known] : kKinds) {
        if (name == known) return kind;
        names.emplace_back(known);
    }
    section.refuse("kind", "no such predicate; " + Section::known_names(name, names));
}

/// A field alone, or a table of field and selection.
std::optional<Quantity> read_quantity(Section& section, std::string_view key) {
    const toml::node* node = section.node(key);
    if (node == nullptr) return std::nullopt;
    if (node->is_string()) {
        return Quantity{parse_figure(node->as_string()->get(), section.where(key)), {}};
    }
    Section table = *section.section(key);
    const std::string field = required_text(table, "field", "a field of a cell");
    return Quantity{parse_figure(field, table.where("field")), read_keys(table, {"field"})};
}

Range read_range(Section& section) {
    Range range;
    range.least = section.number("least");
    range.most = section.number("most");
    range.above = section.number("above");
    range.below = section.number("below");
    return range;
}

/// What each predicate needs, and no more.
void check_test(Section& section, const Test& test) {
    using Kind = Test::Kind;
    const bool of_table = test.kind == Kind::published || test.kind == Kind::published_rank;
    const bool two = test.kind == Kind::ratio || test.kind == Kind::rank;
    const bool one = test.kind == Kind::bound || of_table;  // the others take a ratio as well
    const bool ranged = test.kind != Kind::constant && test.kind != Kind::rises &&
                        test.kind != Kind::falls && test.kind != Kind::published;
    const bool factor = test.kind == Kind::constant || test.kind == Kind::published;
    const bool along = test.kind == Kind::constant || test.kind == Kind::rises ||
                       test.kind == Kind::falls || test.kind == Kind::rank;
    const auto expect = [&](const char* key, bool needed, const char* what) {
        if (needed && !section.has(key)) section.require(key, what);
        if (!needed && section.has(key)) {
            section.refuse(key, fmt::format("kind = \"{}\" has no use for it; leave it out",
                                            name_of(test.kind)));
        }
    };
    expect("table", of_table, "write the id of a [[table]]");
    expect("of", !of_table, "write a figure, as { field = \"frame_ms.median\" }");
    if (one || two) expect("to", two, "write the other figure");
    expect("within", factor, "write the greatest factor between them, above 1");
    expect("over", along, "write the selections, in order");
    if (ranged == test.range.empty()) {
        section.require("least", ranged ? "write least, most, above or below"
                                        : "this predicate has no range; leave it out");
    }
    if (along && test.over.size() < 2) section.refuse("over", "write two selections or more");
}

/// A published time was taken on another machine, long ago.
void refuse_absolute_times(const Section& section, const Table& table) {
    const bool times = std::ranges::any_of(
        table.columns, [](const Table::Column& column) { return column.figure.is_time(); });
    if (!times || table.baseline_column || table.baseline_row) return;
    section.refuse("table",
                   "its times compare by ratios alone; give the table a baseline_column or a "
                   "baseline_row");
}

Test read_test(Section& section, const Paper& paper) {
    Test test;
    test.where = section.where();
    test.kind = read_kind(section);
    test.words = section.text("words").value_or("");
    test.of = read_quantity(section, "of");
    test.to = read_quantity(section, "to");
    test.range = read_range(section);
    test.within = section.number("within", {1, 1e9}).value_or(0);
    test.strictly = section.boolean("strictly").value_or(false);
    test.for_each = read_selections(section, "for_each", paper);
    test.over = read_selections(section, "over", paper);
    test.table = section.text("table").value_or("");
    if (!test.table.empty() && paper.table(test.table) == nullptr) {
        section.refuse("table", "no [[table]] of this id stands above");
    }
    check_test(section, test);
    if (test.kind == Test::Kind::published)
        refuse_absolute_times(section, *paper.table(test.table));
    section.refuse_unknown(kKind);
    return test;
}

void read_needs(Section& section, Claim& claim) {
    for (const std::string& need : texts(section, "needs")) {
        if (need == "gpu") {
            claim.needs_gpu = true;
        } else if (need == "terrain") {
            claim.needs_terrain = true;
        } else {
            section.refuse("needs", "write \"gpu\", \"terrain\" or both");
        }
    }
}

/// An experiment that is named must be one.
void check_experiments(const Selection& selection, const Paper& paper, const std::string& where) {
    if (selection.experiment.empty() || paper.experiment(selection.experiment) != nullptr) return;
    std::vector<std::string> known;
    for (const Experiment& experiment : paper.experiments) known.push_back(experiment.id);
    throw InputError(fmt::format("{}: there is no experiment {}; {}", where,
                                 base::printable(selection.experiment),
                                 Section::known_names(selection.experiment, known)));
}

std::vector<Test> read_tests(Section& section, const Paper& paper) {
    std::vector<Test> tests;
    for (Section& part : section.sections("test")) tests.push_back(read_test(part, paper));
    return tests;
}

Explanation read_explanation(Section& section, const Paper& paper) {
    Explanation explanation;
    explanation.where = section.where();
    explanation.words = required_text(section, "words", "why the claim may not hold");
    if (section.has("select")) explanation.selection = read_selection(section, "select");
    explanation.tests = read_tests(section, paper);
    if (explanation.tests.empty()) {
        section.require("test",
                        "write [[claim.explanation.test]]: figures decide whether it is so");
    }
    section.refuse_unknown(kKind);
    return explanation;
}

void check_test_experiments(const std::vector<Test>& tests, const Paper& paper) {
    for (const Test& test : tests) {
        for (const auto& list : {test.for_each, test.over}) {
            for (const Selection& selection : list) check_experiments(selection, paper, test.where);
        }
        if (test.of) check_experiments(test.of->selection, paper, test.where);
        if (test.to) check_experiments(test.to->selection, paper, test.where);
    }
}

Claim read_claim(Section& section, const Paper& paper, const std::set<std::string>& taken) {
    Claim claim;
    claim.where = section.where();
    claim.id = read_id(section, taken);
    claim.words = required_text(section, "words", "what the paper claims");
    claim.place = required_text(section, "place", "where it stands in the paper");
    claim.selection = read_selection(section, "select");
    claim.unjudged = section.text("unjudged").value_or("");
    read_needs(section, claim);
    for (Section& part : section.sections("reading")) {
        claim.readings.push_back(
            {required_text(part, "name", "how it is read"), read_selection(part, "select")});
        part.refuse_unknown(kKind);
    }
    if (claim.readings.empty()) claim.readings.emplace_back();
    claim.tests = read_tests(section, paper);
    for (Section& part : section.sections("explanation")) {
        claim.explanations.push_back(read_explanation(part, paper));
    }
    if (claim.tests.empty() == claim.unjudged.empty()) {
        section.require("test", "write [[claim.test]], or unjudged = \"why nothing can judge it\"");
    }
    section.refuse_unknown(kKind);

    check_experiments(claim.selection, paper, claim.where);
    for (const Reading& reading : claim.readings) {
        check_experiments(reading.selection, paper, claim.where);
    }
    check_test_experiments(claim.tests, paper);
    for (const Explanation& explanation : claim.explanations) {
        if (explanation.selection) {
            check_experiments(*explanation.selection, paper, explanation.where);
        }
        check_test_experiments(explanation.tests, paper);
    }
    return claim;
}

OwnTerrain read_terrain(Section& top) {
    auto section = top.section("terrain");
    if (!section) top.require("terrain", "write [terrain] with name = what the paper flew over");
    OwnTerrain terrain;
    terrain.name = required_text(*section, "name", "what the paper flew over");
    for (const char* key : {"spacing", "vertical_scale", "vertical_offset"}) {
        const auto value = section->number(key);
        if (value) terrain.keys += fmt::format(", {} = {}", key, *value);
    }
    section->refuse_unknown(kKind);
    return terrain;
}

template <typename Item>
std::set<std::string> ids_of(const std::vector<Item>& items) {
    std::set<std::string> ids;
    for (const Item& item : items) ids.insert(item.id);
    return ids;
}

void check_tables(const Paper& paper) {
    for (const Table& table : paper.tables) {
        check_experiments(table.selection, paper, table.where);
        for (const auto& column : table.columns) {
            check_experiments(column.selection, paper, table.where);
        }
        for (const auto& row : table.rows) check_experiments(row.selection, paper, table.where);
    }
    for (const LineFigure& figure : paper.figures) {
        check_experiments(figure.selection, paper, figure.where);
        for (const auto& curve : figure.curves) {
            check_experiments(curve.selection, paper, figure.where);
        }
    }
}

}  // namespace

const char* name_of(Test::Kind kind) {
    return std::ranges::find(kKinds, kind, &std::pair<Test::Kind, const char*>::first)->second;
}

std::string OwnTerrain::table_of(const fs::path& terrain_file) const {
    const std::string path = fs::absolute(terrain_file).lexically_normal().string();
    return fmt::format("{{ file = {}{} }}", toml_text(toml::value<std::string>(path)), keys);
}

Paper read_paper(const fs::path& file) {
    const toml::table table = terrain::read_toml(file);
    Section top(table, file, "");
    Paper paper;
    paper.file = file;
    paper.id = file.stem().string();
    paper.title = required_text(top, "title", "the paper's title");
    paper.citation = required_text(top, "citation", "authors, title, where and when");
    paper.hardware = required_text(top, "hardware", "what the paper measured on");
    paper.errata = texts(top, "errata");
    paper.quick = read_overrides(top, "quick");
    paper.terrain = read_terrain(top);
    for (Section& section : top.sections("experiment")) {
        paper.experiments.push_back(
            read_experiment(section, file.parent_path(), ids_of(paper.experiments)));
    }
    for (Section& section : top.sections("table")) {
        paper.tables.push_back(read_table(section, ids_of(paper.tables)));
    }
    for (Section& section : top.sections("figure")) {
        paper.figures.push_back(read_figure(section, ids_of(paper.figures)));
    }
    check_tables(paper);
    for (Section& section : top.sections("claim")) {
        paper.claims.push_back(read_claim(section, paper, ids_of(paper.claims)));
    }
    top.refuse_unknown(kKind);
    return paper;
}

}  // namespace lodbench::reproduce
