#include "report/html/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/plot_svg.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

constexpr std::size_t kDashes = 4;

/// JSON has no infinity and no NaN.
Json::Value finite_or_text(double value) {
    if (std::isnan(value)) return Json::Value::null;
    if (std::isinf(value)) return "inf";
    return value;
}

}  // namespace

bool has_marks(const Plot& plot) {
    return std::ranges::any_of(plot.series, [](const Series& series) {
        return std::ranges::any_of(series.marks, [](const Mark& mark) {
            return !std::isnan(mark.x) && !std::isnan(mark.y);
        });
    });
}

std::vector<Mark> thinned(const std::vector<Mark>& marks, std::size_t most) {
    std::vector<Mark> all;
    std::ranges::copy_if(marks, std::back_inserter(all), [](const Mark& mark) {
        return std::isfinite(mark.x) && std::isfinite(mark.y);
    });
    if (all.size() <= most) return all;
    std::vector<Mark> result;
    const std::size_t stretches = most / 2;
    for (std::size_t i = 0; i < stretches; ++i) {
        const auto begin = all.begin() + std::ptrdiff_t(i * all.size() / stretches);
        const auto end = all.begin() + std::ptrdiff_t((i + 1) * all.size() / stretches);
        auto [least, greatest] =
            std::minmax_element(begin, end, [](const Mark& a, const Mark& b) { return a.y < b.y; });
        if (least > greatest) std::swap(least, greatest);
        result.push_back(*least);
        if (greatest != least) result.push_back(*greatest);
    }
    return result;
}

std::string color_class(std::size_t color) {
    return fmt::format("c{}", color % kColors);
}

std::string key_html(const Series& series) {
    return fmt::format(
        "<svg class=\"key\" viewBox=\"0 0 28 10\" aria-hidden=\"true\"><line class=\"s {} d{}\" "
        "x1=\"1\" y1=\"5\" x2=\"27\" y2=\"5\"/></svg>",
        series.ink ? "ink" : color_class(series.color), series.variant % kDashes);
}

std::string to_html(const Plot& plot) {
    if (!has_marks(plot)) return {};
    std::string html =
        fmt::format("<figure class=\"plot {}{}\" id=\"{}\">\n<figcaption>{}",
                    plot.kind == Plot::Kind::bars ? "bars" : "curves",
                    plot.logarithmic ? " log" : "", escape(plot.id), escape(plot.title));
    if (plot.can_be_logarithmic) {
        html += fmt::format(
            " <label class=\"js-only\"><input type=\"checkbox\" data-log=\"{}\"{}> logarithmic"
            "</label>",
            escape(plot.id), plot.logarithmic ? " checked" : "");
    }
    html += "</figcaption>\n" + to_svg(plot);
    for (const std::string& note : plot.notes) {
        html += fmt::format("<p class=\"note\">{}</p>\n", escape(note));
    }
    return html + "</figure>\n";
}

Json::Value to_json(const Plot& plot) {
    Json::Value json;
    json["id"] = plot.id;
    json["kind"] = plot.kind == Plot::Kind::bars ? "bars" : "curves";
    json["title"] = plot.title;
    json["x"] = plot.x_title;
    json["y"] = plot.y_title;
    json["log"] = plot.logarithmic;
    json["counts"] = plot.counts;
    if (plot.reference) json["reference"] = *plot.reference;
    json["series"] = Json::arrayValue;
    for (const Series& series : plot.series) {
        Json::Value entry;
        entry["name"] = series.name;
        entry["toggle"] = series.toggle;
        entry["color"] = series.ink ? -1 : int(series.color % kColors);
        entry["shape"] = int(series.color / kColors);
        entry["variant"] = int(series.variant % kDashes);
        entry["joined"] = series.joined;
        entry["dots"] = series.dots;
        entry["marks"] = Json::arrayValue;
        for (const Mark& mark : series.marks) {
            // As arrays: half the size of objects.
            Json::Value point = Json::arrayValue;
            point.append(finite_or_text(mark.x));
            point.append(finite_or_text(mark.y));
            const bool interval = !std::isnan(mark.low) && !std::isnan(mark.high);
            if (interval || mark.ringed || !mark.label.empty()) {
                point.append(mark.label);
                point.append(mark.ringed);
            }
            if (interval) {
                point.append(finite_or_text(mark.low));
                point.append(finite_or_text(mark.high));
            }
            entry["marks"].append(point);
        }
        json["series"].append(entry);
    }
    json["categories"] = Json::arrayValue;
    for (const Category& category : plot.categories) {
        Json::Value entry;
        entry["label"] = category.label;
        entry["toggle"] = category.toggle;
        entry["color"] = int(category.color % kColors);
        json["categories"].append(entry);
    }
    return json;
}

}  // namespace lodbench::report::html
