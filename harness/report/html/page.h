#pragma once
// The page as it grows, section by section.

#include <json/value.h>

#include <string>
#include <string_view>
#include <vector>

#include "report/html/data.h"
#include "report/html/pictures.h"
#include "report/html/plot.h"
#include "report/html/table.h"

namespace lodbench::report::html {

class Page {
public:
    Page() : pictures_(kPictureBytes) {}

    void heading(int level, const std::string& title, const std::string& id = {});
    void paragraph(std::string_view text, const char* kind = nullptr);
    /// "Not measured: REASON."
    void not_measured(std::string_view reason);
    void list(const std::vector<std::string>& texts);
    /// Takes it into the page, of a long one the first rows, and whole into the CSV.
    void table(const Table& table, std::size_t most_rows = kMostRows);
    /// Into the CSV alone.
    void csv_only(const Table& table) { csv_.add(table); }
    /// Side by side where there is room; false where none of them has anything to show.
    bool plots(const std::vector<Plot>& plots, bool wide = false);
    /// What is HTML already.
    void raw(std::string_view html) { body_ += html; }
    /// A name and what follows it up to `close`, which can be opened and closed.
    void open_details(const std::string& summary);
    void close_details() { body_ += "</details>\n"; }

    [[nodiscard]] PictureBudget& pictures() { return pictures_; }
    [[nodiscard]] const CsvTables& csv() const { return csv_; }
    /// Those with something to show, in their order.
    [[nodiscard]] const std::vector<Plot>& drawn_plots() const { return drawn_plots_; }

    /// The whole document. `title` and `lead` (HTML) stand at its top.
    [[nodiscard]] std::string document(const std::string& title, const std::string& lead) const;

private:
    struct Link {
        int level;
        std::string id, title;
    };
    std::string body_;
    std::vector<Link> links_;  // to the headings that have an id
    std::vector<Plot> drawn_plots_;
    CsvTables csv_;
    PictureBudget pictures_;
};

}  // namespace lodbench::report::html
