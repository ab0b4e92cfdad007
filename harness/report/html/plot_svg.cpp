#include "report/html/plot_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/axis.h"
#include "report/html/text.h"

namespace lodbench::report::html {

namespace {

// Units of the picture, which is scaled to the page: what is 480 wide is still read on a telephone.
constexpr double kWidth = 480;
constexpr double kHeight = 320;
constexpr double kLeft = 58;
constexpr double kRight = 470;
constexpr double kTop = 10;
constexpr double kBottom = 272;
constexpr double kDot = 3.2;
constexpr std::size_t kUsualLabel = 4;  // characters beside the field
constexpr double kDigitWidth = 7.5;
// Bars.
constexpr double kBarLeft = 150;
constexpr double kBarRight = 420;  // room for the value behind it
constexpr std::size_t kLabelLength = 20;

std::string classes(const Series& series) {
    return series.ink ? "ink" : color_class(series.color);
}

/// Circle, square, diamond, triangle: methods of one colour differ in shape.
std::string dot(double x, double y, std::size_t shape, const std::string& title) {
    const double r = kDot;
    std::string form;
    switch (shape % 4) {
        case 0:
            form =
                fmt::format("<circle class=\"f\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\">", x, y, r);
            break;
        case 1:
            form = fmt::format("<path class=\"f\" d=\"M{:.1f} {:.1f}h{r2}v{r2}h-{r2}z\">", x - r,
                               y - r, fmt::arg("r2", 2 * r));
            break;
        case 2:
            form =
                fmt::format("<path class=\"f\" d=\"M{:.1f} {:.1f}l{r} {r}l-{r} {r}l-{r} -{r}z\">",
                            x, y - r - 1, fmt::arg("r", r + 1));
            break;
        default:
            form = fmt::format("<path class=\"f\" d=\"M{:.1f} {:.1f}l{r} {r2}h-{r2}z\">", x,
                               y - r - 1, fmt::arg("r", r + 1), fmt::arg("r2", 2 * r + 2));
    }
    if (!title.empty()) form += "<title>" + escape(title) + "</title>";
    return form + (shape % 4 == 0 ? "</circle>" : "</path>");
}

/// What the method's box in the legend shows and hides.
std::string toggle(const std::string& method) {
    return method.empty() ? "" : fmt::format(" data-toggle=\"{}\"", escape(method));
}

std::string x_axis(const Axis& axis, const std::string& title, double top, double bottom,
                   double left, double right) {
    std::string svg;
    for (const double tick : axis.ticks()) {
        const double x = axis.place(tick);
        svg += fmt::format(
            "<path class=\"grid\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/><text x=\"{0:.1f}\" "
            "y=\"{3:.1f}\" class=\"mid\">{4}</text>",
            x, top, bottom, bottom + 17, tick_text(tick));
    }
    return svg + fmt::format("\n<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"mid title\">{}</text>\n",
                             (left + right) / 2, bottom + 39, escape(title));
}

/// Where the field begins: long numbers need more room beside it.
double left_of(const Axis& y, bool spanning) {
    if (!spanning) return kLeft;
    std::size_t longest = kUsualLabel;
    for (const double tick : y.ticks()) longest = std::max(longest, y.tick_label(tick).size());
    return kLeft + kDigitWidth * double(longest - kUsualLabel);
}

std::string y_axis(const Axis& axis, const std::string& title, double left) {
    std::string svg;
    for (const double tick : axis.ticks()) {
        const double y = axis.place(tick);
        svg += fmt::format(
            "<path class=\"grid\" d=\"M{} {:.1f}H{}\"/><text x=\"{}\" y=\"{:.1f}\" "
            "class=\"end\">{}</text>",
            left, y, kRight, left - 6, y + 4, axis.tick_label(tick));
    }
    return svg + fmt::format(
                     "\n<text transform=\"translate(13 {:.1f}) rotate(-90)\" class=\"mid "
                     "title\">{}</text>\n",
                     (kTop + kBottom) / 2, escape(title));
}

Axis::Scale scale_of(const Plot& plot) {
    return plot.logarithmic ? Axis::Scale::logarithmic : Axis::Scale::from_zero;
}

/// Both ends of a label that is too long, since settings of one method differ at the end; whole
/// UTF-8 characters.
std::string shortened(const std::string& label) {
    std::vector<std::size_t> begins;  // of the characters
    for (std::size_t i = 0; i < label.size(); ++i) {
        if ((static_cast<unsigned char>(label[i]) & 0xC0) != 0x80) begins.push_back(i);
    }
    if (begins.size() <= kLabelLength) return label;
    constexpr std::size_t kHead = kLabelLength / 2;
    const std::size_t tail = begins[begins.size() + kHead + 1 - kLabelLength];
    return label.substr(0, begins[kHead]) + "…" + label.substr(tail);
}

/// To the right above the point, or to the left where there is no room.
std::string value_beside(double x, double y, const std::string& text) {
    const bool room = x < kRight - 60;
    return fmt::format("<text class=\"value{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                       room ? "" : " end", room ? x + kDot + 3 : x - kDot - 3, y - kDot - 2,
                       escape(text));
}

std::string series_svg(const Series& series, const Axis& x, const Axis& y) {
    std::string line;
    std::string dots;
    for (const Mark& mark : series.marks) {
        if (!std::isfinite(mark.x) || !std::isfinite(mark.y)) continue;
        const double left = x.place(mark.x);
        const double top = y.place(mark.y);
        line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? 'M' : 'L', left, top);
        if (mark.ringed) {
            dots += fmt::format("<circle class=\"ring\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>",
                                left, top, kDot + 3);
        }
        if (series.dots) {
            const std::string title =
                mark.label.empty()
                    ? std::string()
                    : fmt::format("{}: {}, {}", mark.label, tick_text(mark.x), tick_text(mark.y));
            dots += dot(left, top, series.color / kColors, title);
            if (!mark.value.empty()) dots += value_beside(left, top, shortened(mark.value));
        }
    }
    std::string svg = fmt::format("<g class=\"{} d{}\"{}>", classes(series), series.variant % 4,
                                  toggle(series.toggle));
    if (series.joined && !line.empty()) {
        svg += fmt::format("<path class=\"s\" d=\"{}\"><title>{}</title></path>", line,
                           escape(series.name));
    }
    return svg + dots + "</g>\n";
}

Drawing draw_curves(const Plot& plot) {
    std::vector<double> xs;
    std::vector<double> ys;
    for (const Series& series : plot.series) {
        for (const Mark& mark : series.marks) {
            if (!std::isfinite(mark.x) || !std::isfinite(mark.y)) continue;
            xs.push_back(mark.x);
            ys.push_back(mark.y);
        }
    }
    const Axis::Scale scale = scale_of(plot);
    const bool spanning = !plot.from_zero && scale != Axis::Scale::logarithmic;
    const Axis y(ys, spanning ? Axis::Scale::spanning : scale, kBottom, kTop);
    const double left = left_of(y, spanning);
    const Axis x(xs, plot.counts ? Axis::Scale::counting : scale, left, kRight);
    std::string svg =
        x_axis(x, plot.x_title, kTop, kBottom, left, kRight) + y_axis(y, plot.y_title, left);
    for (const Series& series : plot.series) svg += series_svg(series, x, y);
    return {kWidth, kHeight, svg,
            fmt::format(" data-x=\"{}\" data-y=\"{}\"", x.numbers(), y.numbers())};
}

std::string bar_svg(const Mark& mark, const Axis& axis, double top, double thickness, double zero) {
    const bool infinite = std::isinf(mark.x);
    const double end = infinite ? kBarRight : axis.place(mark.x);
    const double middle = top + thickness / 2;
    std::string svg = fmt::format(
        "<rect class=\"f\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", zero,
        top, std::max(end - zero, 1.0), thickness - 1);
    double behind = end;
    if (std::isfinite(mark.low) && std::isfinite(mark.high) && mark.high > mark.low) {
        const double low = axis.place(mark.low);
        behind = std::max(end, axis.place(mark.high));
        svg += fmt::format(
            "<path class=\"whisker\" d=\"M{0:.1f} {2:.1f}H{1:.1f}M{0:.1f} {3:.1f}v4M{1:.1f} "
            "{3:.1f}v4\"/>",
            low, axis.place(mark.high), middle, middle - 2);
    }
    return svg + fmt::format("<text class=\"value\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                             behind + 5, middle + 4, infinite ? "∞" : tick_text(mark.x));
}

/// "lindstrom tau=1, P90: 12.5 (12 to 13)"
std::string bar_title(const Category& category, const Series& series, const Mark& mark) {
    std::string title = fmt::format("{}, {}: {}", category.label, series.name,
                                    std::isinf(mark.x) ? "∞" : tick_text(mark.x));
    if (std::isfinite(mark.low) && std::isfinite(mark.high)) {
        title += fmt::format(" ({} to {})", tick_text(mark.low), tick_text(mark.high));
    }
    return title;
}

Drawing draw_bars(const Plot& plot) {
    const double thickness = plot.series.size() > 1 ? 11 : 15;
    const double step = thickness * double(plot.series.size()) + 8;
    const double bottom = kTop + step * double(plot.categories.size());
    std::vector<double> values;
    for (const Series& series : plot.series) {
        for (const Mark& mark : series.marks) {
            values.insert(values.end(), {mark.x, mark.high});
        }
    }
    if (plot.reference) values.push_back(*plot.reference);
    const Axis axis(values, scale_of(plot), kBarLeft, kBarRight);
    const double zero = plot.logarithmic ? kBarLeft : axis.place(0);
    std::string svg = x_axis(axis, plot.x_title, kTop, bottom, kBarLeft, kBarRight);
    for (std::size_t i = 0; i < plot.categories.size(); ++i) {
        const Category& category = plot.categories[i];
        const double top = kTop + step * double(i) + 4;
        svg += fmt::format(
            "<g class=\"{}\"{}><text class=\"end\" x=\"{}\" y=\"{:.1f}\">{}<title>{}</title>"
            "</text>",
            color_class(category.color), toggle(category.toggle), kBarLeft - 8, top + step / 2,
            escape(shortened(category.label)), escape(category.label));
        for (std::size_t s = 0; s < plot.series.size(); ++s) {
            svg += fmt::format("<g class=\"o{}\">", plot.series[s].variant);
            for (const Mark& mark : plot.series[s].marks) {
                if (mark.y != double(i) || std::isnan(mark.x)) continue;
                svg +=
                    fmt::format("<g>{}<title>{}</title></g>",
                                bar_svg(mark, axis, top + thickness * double(s), thickness, zero),
                                escape(bar_title(category, plot.series[s], mark)));
            }
            svg += "</g>";
        }
        svg += "</g>\n";
    }
    if (plot.reference) {
        svg += fmt::format("<path class=\"reference\" d=\"M{:.1f} {}V{:.1f}\"/>\n",
                           axis.place(*plot.reference), kTop, bottom);
    }
    return {kWidth, bottom + 46, svg, {}};
}

}  // namespace

Drawing draw(const Plot& plot) {
    return plot.kind == Plot::Kind::bars ? draw_bars(plot) : draw_curves(plot);
}

std::string to_svg(const Plot& plot) {
    std::string svgs;
    Plot drawn = plot;
    for (const bool logarithmic : {false, true}) {
        if (logarithmic != plot.logarithmic && !plot.can_be_logarithmic) continue;
        drawn.logarithmic = logarithmic;
        const Drawing drawing = draw(drawn);
        const char* const kind = !plot.can_be_logarithmic ? ""
                                 : logarithmic            ? " class=\"logarithmic\""
                                                          : " class=\"linear\"";
        svgs += fmt::format(
            "<svg{} viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\"{}>\n{}</svg>\n",
            kind, drawing.width, drawing.height,
            escape(fmt::format("{}: {} against {}", plot.title, plot.y_title, plot.x_title)),
            drawing.axes, drawing.shapes);
    }
    return svgs;
}

std::string key_svg(const Plot& plot, const Series& series, double x, double y) {
    if (plot.kind == Plot::Kind::bars) {
        return fmt::format(
            "<g class=\"ink o{}\"><rect class=\"f\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" "
            "height=\"10\"/></g>",
            series.variant, x, y - 5, kKeyWidth);
    }
    std::string shapes;
    if (series.joined) {
        shapes = fmt::format("<path class=\"s\" d=\"M{:.1f} {:.1f}h{}\"/>", x, y, kKeyWidth);
    }
    if (series.dots) shapes += dot(x + kKeyWidth / 2, y, series.color / kColors, "");
    return fmt::format("<g class=\"{} d{}\">{}</g>", classes(series), series.variant % 4, shapes);
}

}  // namespace lodbench::report::html
