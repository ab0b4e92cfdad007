#pragma once
// A table of the report: one description, from which come its HTML and its CSV.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::report::html {

struct Column {
    enum class Place { both, page, csv };
    std::string title;  ///< "median frame, ms"
    std::string field;  ///< of cells.jsonl where it is one: "frame_ms.median"; the CSV's header
    bool numeric = true;
    std::string explanation = {};  ///< shown when one points at the title
    Place place = Place::both;
};

/// One field: what is read, and what it is exactly.
struct Field {
    std::string text;
    std::string value;  ///< data-value, and the CSV's field; "" for what was not measured
};
[[nodiscard]] Field text_field(std::string text);
/// As `readable` after division by `unit`; the value is exact and undivided.
[[nodiscard]] Field number_field(std::optional<double> value, int digits, double unit = 1);

/// Whose row it is, in columns of their own in the CSV.
struct Setting {
    std::string scenario;
    std::string method;                         ///< its id
    std::map<std::string, std::string> params;  ///< all of them
};
[[nodiscard]] Setting setting_of(const results::CellRecord& cell);

struct Table {
    std::string id;       ///< the CSV's name; one for all tables of this kind
    std::string caption;  ///< text
    std::vector<Column> columns;
    std::vector<std::vector<Field>> rows;  ///< the first field of a row is its header
    std::string results;                   ///< folder and
    std::string scenario;                  ///< scenario that it is of; "" for none
    /// Of each row its own, or of none. Then the CSV says them instead of the columns "method",
    /// which is a label, and "scenario".
    std::vector<Setting> settings = {};
};

/// In a box of its own that scrolls.
[[nodiscard]] std::string to_html(const Table& table);

/// Tables by their id, those of one id below each other: RFC 4180. In front stand the folder and
/// the scenario and, of rows that are of a setting, its method and a column for each parameter of
/// which some method has several values, in whichever table: all files have the same of these
/// columns. Where a parameter has the name of another column it is "params.NAME".
class CsvTables {
public:
    void add(const Table& table) { tables_[table.id].push_back(table); }
    [[nodiscard]] std::map<std::string, std::string> files() const;

private:
    [[nodiscard]] std::set<std::string> swept() const;
    std::map<std::string, std::vector<Table>> tables_;
};

}  // namespace lodbench::report::html
