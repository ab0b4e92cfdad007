// docs/results.md says of every field what its table says: the part between the marks is generated.
// With LODBENCH_WRITE_DOCS set in the environment it is written instead of compared.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

#include "base/files.h"
#include "results/cell.h"
#include "results/frame.h"
#include "results/run_record.h"

namespace lodbench::results {
namespace {

template <typename T>
struct ItemOf {
    using Type = T;
};
template <typename T>
struct ItemOf<std::optional<T>> : ItemOf<T> {};
template <typename T>
struct ItemOf<std::vector<T>> : ItemOf<T> {};

template <typename Record>
std::string table_of() {
    std::string text = "| field | unit | meaning |\n|---|---|---|\n";
    each_field<Record>([&](const auto& field) {
        text += fmt::format("| `{}` | {} | {} |\n", field.name, field.unit, field.meaning);
    });
    return text;
}

/// The tables of the records that nest in `Record`, each once, with the fields that are of it.
class Nested {
public:
    template <typename Record>
    void add() {
        each_field<Record>([&](const auto& field) {
            using Member = std::remove_cvref_t<decltype(std::declval<Record>().*field.member)>;
            using Item = typename ItemOf<Member>::Type;
            if constexpr (IsRecord<Item> && !std::is_same_v<Item, Record>) {
                const std::type_index type(typeid(Item));
                for (Table& table : tables_) {
                    if (table.type == type) return table.fields.push_back(field.name);
                }
                tables_.push_back({type, {field.name}, table_of<Item>()});
                add<Item>();
            }
        });
    }
    [[nodiscard]] std::string text() const {
        std::string text;
        for (const Table& table : tables_) {
            std::string names;
            for (const std::string& name : table.fields) {
                names += fmt::format("{}`{}`", names.empty() ? "" : ", ", name);
            }
            text += fmt::format("\nIn {}:\n\n{}", names, table.text);
        }
        return text;
    }

private:
    struct Table {
        std::type_index type;
        std::vector<std::string> fields;
        std::string text;
    };
    std::vector<Table> tables_;
};

std::string fields_text() {
    Nested nested, of_run;
    nested.add<CellRecord>();
    of_run.add<RunRecord>();
    return "\n## Fields of a cell\n\n" + table_of<CellRecord>() + nested.text() +
           "\n## Columns of a frame's row\n\n" + table_of<FrameRecord>() +
           "\n## Members of run.json\n\n" + table_of<RunRecord>() + of_run.text() + "\n";
}

TEST(ResultsPage, says_of_every_field_what_its_table_says) {
    const std::filesystem::path file =
        std::filesystem::path(LODBENCH_SOURCE_DIR) / "docs/results.md";
    const std::string page = base::read_text(file);
    const std::string begin = "<!-- fields: begin -->\n";
    const std::string end = "<!-- fields: end -->\n";
    const std::size_t from = page.find(begin);
    const std::size_t to = page.find(end);
    ASSERT_TRUE(from != page.npos && to != page.npos && from < to);
    const std::size_t inner = from + begin.size();
    if (std::getenv("LODBENCH_WRITE_DOCS") != nullptr) {
        base::write_whole(file, page.substr(0, inner) + fields_text() + page.substr(to));
        return;
    }
    EXPECT_EQ(page.substr(inner, to - inner), fields_text())
        << "a field table has changed: run this test with LODBENCH_WRITE_DOCS=1 and read the page";
}

TEST(ResultsPage, every_field_has_a_meaning) {
    const auto check = [](const auto& field) {
        EXPECT_NE(std::string(field.meaning), "") << field.name;
    };
    each_field<CellRecord>(check);
    each_field<FrameRecord>(check);
    each_field<RunRecord>(check);
}

}  // namespace
}  // namespace lodbench::results
