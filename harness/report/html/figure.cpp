#include "report/html/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/error.h"
#include "report/html/page_files.h"
#include "report/html/plot_svg.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

constexpr double kTitleHeight = 22;
constexpr double kLineHeight = 17;
constexpr double kGap = 14;            // between entries of the legend
constexpr double kCharacterWidth = 7;  // of 12 units' text, rather too much than too little

/// A colour of the page on paper: the style sheet has the light ones first.
std::string color_of(const std::string& name) {
    const std::string_view css = page_css().text;
    const std::string key = "--" + name + ": ";
    const std::size_t at = css.find(key);
    if (at == css.npos) throw ContractError("the page's style has no colour " + key);
    const std::size_t begin = at + key.size();
    return std::string(css.substr(begin, css.find(';', begin) - begin));
}

/// The page's rules for plots, without its variables: other programs know none.
std::string style() {
    std::string css = fmt::format(
        "text {{ font: 12px \"DejaVu Sans\", \"Liberation Sans\", Arial, sans-serif; fill: {soft}; "
        "}}\n"
        ".title {{ fill: {ink}; }} .heading {{ font-size: 14px; font-weight: bold; fill: {ink}; "
        "}}\n"
        ".value {{ font-size: 10px; }} .mid {{ text-anchor: middle; }} .end {{ text-anchor: end; "
        "}}\n"
        ".grid {{ stroke: {grid}; fill: none; }} .s {{ stroke: currentColor; fill: none; "
        "stroke-width: "
        "1.8; }}\n"
        ".f {{ fill: currentColor; }} .ring, .whisker {{ fill: none; stroke: {ink}; stroke-width: "
        "1.2; "
        "}}\n"
        ".reference {{ stroke: {ink}; stroke-width: 1.4; stroke-dasharray: 5 3; }}\n"
        ".d1 .s {{ stroke-dasharray: 7 3; }} .d2 .s {{ stroke-dasharray: 2 3; }} "
        ".d3 .s {{ stroke-dasharray: 9 3 2 3; }}\n"
        ".o1 .f {{ opacity: 0.72; }} .o2 .f {{ opacity: 0.5; }} .o3 .f {{ opacity: 0.32; }}\n"
        ".ink {{ color: {ink}; }}",
        fmt::arg("soft", color_of("soft")), fmt::arg("ink", color_of("ink")),
        fmt::arg("grid", color_of("grid")));
    for (std::size_t i = 0; i < kColors; ++i) {
        css +=
            fmt::format(" .{} {{ color: {}; }}", color_class(i), color_of(fmt::format("c{}", i)));
    }
    return css;
}

std::size_t characters(const std::string& text) {
    return std::size_t(std::ranges::count_if(
        text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Rows of keys and names below the plot. `height` grows by them.
std::string legend(const Plot& plot, double width, double& height) {
    // Bars have their names beside them; several to a category differ in how faint they are.
    if (plot.kind == Plot::Kind::bars && plot.series.size() < 2) return {};
    std::string svg;
    double x = 8;
    height += kLineHeight;
    for (const Series& series : plot.series) {
        const double entry =
            kKeyWidth + 5 + kCharacterWidth * double(characters(series.name)) + kGap;
        if (x > 8 && x + entry > width) {
            x = 8;
            height += kLineHeight;
        }
        svg += key_svg(plot, series, x, height - 10);
        svg += fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                           x + kKeyWidth + 5, height - 6, escape(series.name));
        x += entry;
    }
    return svg;
}

}  // namespace

std::string figure_svg(const Plot& plot) {
    const Drawing drawing = draw(plot);
    double height = kTitleHeight + drawing.height;
    const std::string names = legend(plot, drawing.width, height);
    std::string notes = fmt::format("{}: {} against {}.", plot.title, plot.y_title, plot.x_title);
    for (const std::string& note : plot.notes) notes += " " + note;
    height += 4;
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\">\n<title>{2}</title>\n<desc>{3}</desc>\n"
        "<style type=\"text/css\">\n{4}\n</style>\n"
        "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n"
        "<text class=\"heading\" x=\"8\" y=\"16\">{2}</text>\n"
        "<g transform=\"translate(0 {5:.0f})\">\n{6}</g>\n{7}</svg>\n",
        drawing.width, height, escape(plot.title), escape(notes), style(), kTitleHeight,
        drawing.shapes, names);
}

const Plot& find_plot(std::span<const Plot> plots, const std::string& name) {
    std::vector<const Plot*> fitting;
    std::string known;
    for (const Plot& plot : plots) {
        if (plot.id == name) return plot;
        if (plot.id.ends_with("-" + name)) fitting.push_back(&plot);
        known += fmt::format("\n  {:<28} {}", plot.id, plot.title);
    }
    if (fitting.size() == 1) return *fitting.front();
    throw InputError(
        fmt::format("--figure {}: {}; the report has{}", name,
                    fitting.empty() ? "there is no such plot" : "several scenarios have that plot",
                    known.empty() ? " none" : ":" + known));
}

}  // namespace lodbench::report::html
