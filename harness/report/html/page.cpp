#include "report/html/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/html/page_files.h"
#include "report/html/text.h"

namespace lodbench::report::html {

void Page::heading(int level, const std::string& title, const std::string& id) {
    if (!id.empty()) links_.push_back({level, id, title});
    body_ += fmt::format("<h{0}{1}>{2}</h{0}>\n", level,
                         id.empty() ? "" : fmt::format(" id=\"{}\"", escape(id)), escape(title));
}

void Page::paragraph(std::string_view text, const char* kind) {
    body_ += fmt::format("<p{}>{}</p>\n", kind == nullptr ? "" : fmt::format(" class=\"{}\"", kind),
                         escape(text));
}

void Page::not_measured(std::string_view reason) {
    body_ += fmt::format("<p class=\"absent\">Not measured: {}.</p>\n", escape(reason));
}

void Page::list(const std::vector<std::string>& texts) {
    body_ += "<ul>\n";
    for (const std::string& text : texts) body_ += "<li>" + escape(text) + "</li>\n";
    body_ += "</ul>\n";
}

void Page::table(const Table& table, std::size_t most_rows) {
    csv_.add(table);
    if (table.rows.size() <= most_rows) {
        body_ += to_html(table);
        return;
    }
    Table shorter = table;
    shorter.rows.resize(most_rows);
    body_ += to_html(shorter);
    paragraph(fmt::format("The first {} of {} rows; `lodbench report --csv` writes all of them.",
                          most_rows, table.rows.size()),
              "note");
}

bool Page::plots(const std::vector<Plot>& plots, bool wide) {
    std::string figures;
    for (const Plot& plot : plots) {
        figures += to_html(plot);
        if (has_marks(plot)) drawn_plots_.push_back(plot);
    }
    if (figures.empty()) return false;
    body_ += fmt::format("<div class=\"plots{}\">\n{}</div>\n", wide ? " wide" : "", figures);
    return true;
}

void Page::open_details(const std::string& summary) {
    body_ += fmt::format("<details><summary>{}</summary>\n", escape(summary));
}

std::string Page::document(const std::string& title, const std::string& lead) const {
    const PageFile css = page_css();
    const PageFile script = page_js();
    std::string links;
    // Sections below a scenario only where there is one: many would hide it all.
    const bool one = std::ranges::count(links_, 2, &Link::level) <= 3;
    for (const Link& link : links_) {
        if (link.level > 2 && !one) continue;
        links +=
            fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escape(link.id), escape(link.title));
    }
    // Nothing is fetched and nothing sent; what a hostile file might smuggle in does not run.
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "img-src data:; style-src '{}'; script-src '{}'; base-uri 'none'; "
        "form-action 'none'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n",
        css.hash, script.hash, escape(title));
    html.append("<style>").append(css.text).append("</style>\n</head>\n<body>\n");
    html += fmt::format(
        "<a class=\"skip\" href=\"#content\">Skip to the results</a>\n<header>\n<h1>{}</h1>\n{}"
        "<nav aria-label=\"Sections\"><ul>\n{}</ul></nav>\n</header>\n<main id=\"content\">\n",
        escape(title), lead, links);
    html += body_;
    Json::Value data;
    data["plots"] = Json::arrayValue;
    for (const Plot& plot : drawn_plots_) data["plots"].append(to_json(plot));
    html.append("</main>\n<script type=\"application/json\" id=\"report-data\">")
        .append(json_for_script(data))
        .append("</script>\n<script>")
        .append(script.text)
        .append("</script>\n</body>\n</html>\n");
    return html;
}

}  // namespace lodbench::report::html
