#pragma once
// A table of the report: one description, from which come its HTML and its CSV.

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lodbench::report::html {

struct Column {
    std::string title;  ///< "median frame, ms"
    std::string field;  ///< of cells.jsonl where it is one: "frame_ms.median"; the CSV's header
    bool numeric = true;
    std::string explanation = {};  ///< shown when one points at the title
};

/// One field: what is read, and what it is exactly.
struct Field {
    std::string text;
    std::string value;  ///< data-value, and the CSV's field; "" for what was not measured
};
[[nodiscard]] Field text_field(std::string text);
/// As `readable` after division by `unit`; the value is exact and undivided.
[[nodiscard]] Field number_field(std::optional<double> value, int digits, double unit = 1);

struct Table {
    std::string id;       ///< the CSV's name; one for all tables of this kind
    std::string caption;  ///< text
    std::vector<Column> columns;
    std::vector<std::vector<Field>> rows;  ///< the first field of a row is its header
    std::string results;                   ///< folder and
    std::string scenario;                  ///< scenario that it is of; "" for none
};

/// In a box of its own that scrolls.
[[nodiscard]] std::string to_html(const Table& table);

/// Tables by their id, those of one id below each other: RFC 4180, with the folder and the scenario
/// in front.
class CsvTables {
public:
    void add(const Table& table);
    [[nodiscard]] const std::map<std::string, std::string>& files() const { return files_; }

private:
    std::map<std::string, std::string> files_;
};

}  // namespace lodbench::report::html
