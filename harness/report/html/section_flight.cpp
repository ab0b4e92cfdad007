// Along the flight: curves by frame, and the way over the ground.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "picture/truth_picture.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

Plot curve_plot(const ReportData& data, const ResultSet& set, const char* column, const char* title,
                const char* axis, bool dots) {
    Plot plot;
    plot.id = fmt::format("{}-curve-{}", set.id, slug(column));
    plot.title = title;
    plot.x_title = "frame";
    plot.y_title = axis;
    plot.counts = true;
    bool thinner = false;
    const std::vector<std::size_t> chosen = choose_groups(set, kMostCurves);
    for (const std::size_t i : chosen) {
        const results::CellGroup& group = set.groups[i];
        const std::vector<double> values = frame_column(set, group, column);
        std::vector<Mark> marks;
        for (std::size_t frame = 0; frame < values.size(); ++frame) {
            if (std::isfinite(values[frame])) marks.push_back({double(frame), values[frame]});
        }
        if (marks.empty()) continue;
        Series series{group.label, group.method};
        series.color = data.color_of(group);
        series.variant = variant_of(set, i);
        series.dots = dots;
        thinner = thinner || marks.size() > kMostCurvePoints;
        series.marks = thinned(marks, kMostCurvePoints);
        plot.series.push_back(std::move(series));
    }
    if (thinner) {
        plot.notes.push_back(fmt::format(
            "Drawn are at most {} points a curve: least and greatest of each stretch of frames.",
            kMostCurvePoints));
    }
    if (std::string note = left_out_note(set, chosen.size()); !note.empty()) {
        plot.notes.push_back(std::move(note));
    }
    return plot;
}

/// Metres to the map's units, whose y points down.
struct MapFrame {
    glm::dvec2 low, high;
    double scale;
    [[nodiscard]] glm::dvec2 place(const glm::dvec3& position) const {
        return {(position.x - low.x) * scale, (high.y - position.y) * scale};
    }
};

/// The flight with ground around it: a cut-out of a large terrain, else all of it; and the flight
/// where it leads beyond.
MapFrame frame_of(const results::FlightRecord& flight) {
    glm::dvec2 first = flight.positions.front();
    glm::dvec2 last = first;
    for (const glm::dvec3& position : flight.positions) {
        first = glm::min(first, glm::dvec2(position));
        last = glm::max(last, glm::dvec2(position));
    }
    constexpr double kLeastPart = 0.35;  // of the terrain: below it, the hillshade is a blur
    const glm::dvec2 extent = flight.high - flight.low;
    const double half = std::max(
        {last.x - first.x, last.y - first.y, kLeastPart * std::max(extent.x, extent.y) / 2});
    const glm::dvec2 centre = (first + last) / 2.0;
    const glm::dvec2 low = glm::min(glm::max(centre - half, flight.low), first);
    const glm::dvec2 high = glm::max(glm::min(centre + half, flight.high), last);
    return {low, high, 480 / std::max({high.x - low.x, high.y - low.y, 1e-9})};
}

std::string path_svg(const results::FlightRecord& flight, const MapFrame& map) {
    std::string line;
    const std::size_t count = flight.positions.size();
    const std::size_t step = std::max<std::size_t>(1, count / kMostCurvePoints);
    for (std::size_t i = 0; i < count; i += step) {
        const glm::dvec2 at = map.place(flight.positions[i]);
        line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? 'M' : 'L', at.x, at.y);
    }
    return fmt::format("<path class=\"case\" d=\"{0}\"/><path class=\"way\" d=\"{0}\"/>\n", line);
}

/// A short stroke in the direction of view, at ten frames of the flight.
std::string views_svg(const results::FlightRecord& flight, const MapFrame& map) {
    constexpr double kLength = 16;
    std::string svg;
    const std::size_t count = flight.positions.size();
    std::set<std::size_t> frames;
    for (std::size_t k = 0; k < 10; ++k) frames.insert(k * (count - 1) / 9);
    for (const std::size_t frame : frames) {
        const glm::dvec2 at = map.place(flight.positions[frame]);
        const glm::dvec3& view = flight.directions[frame];
        svg += fmt::format(
            "<path class=\"view\" d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}\"><title>frame {}: {:.0f} m "
            "high</title></path>",
            at.x, at.y, view.x * kLength, -view.y * kLength, frame, flight.positions[frame].z);
    }
    const glm::dvec2 start = map.place(flight.positions.front());
    const glm::dvec2 end = map.place(flight.positions.back());
    return svg + fmt::format(
                     "<circle class=\"start\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>first "
                     "frame</title></circle><path class=\"end-mark\" d=\"M{:.1f} "
                     "{:.1f}m-5 -5h10v10h-10z\"><title>last frame</title></path>\n",
                     start.x, start.y, end.x, end.y);
}

/// Where each method's picture was worst.
std::string worst_svg(const ReportData& data, const ResultSet& set, const MapFrame& map) {
    std::string svg;
    for (const std::size_t i : choose_groups(set, kMostCurves)) {
        const results::CellGroup& group = set.groups[i];
        for (const results::CellRecord* cell : group.good) {
            if (!cell->pixel_error_px || !cell->pixel_error_px->worst) continue;
            const auto frame = std::size_t(cell->pixel_error_px->worst->frame);
            if (frame >= set.flight->positions.size()) continue;
            const glm::dvec2 at = map.place(set.flight->positions[frame]);
            svg += fmt::format(
                "<g class=\"{}\"><path class=\"worst\" d=\"M{:.1f} {:.1f}m0 {}l5 8h-10z\">"
                "<title>worst pixel of {}: frame {}</title></path></g>\n",
                color_class(data.color_of(group)), at.x, at.y, -16 - 10 * int(i % 4),
                escape(group.label), frame);
        }
    }
    return svg;
}

}  // namespace

void add_curves(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Along the flight", set.id + "-curves");
    const bool drawn = page.plots(
        {curve_plot(data, set, "wall_ms", "Frame time along the flight", "frame time, ms", false),
         curve_plot(data, set, "triangles", "Triangles along the flight", "triangles", false),
         curve_plot(data, set, "pixel_p999_px", "Pixel error along the flight",
                    "pixel error P99.9, px", true),
         curve_plot(data, set, "popping_p999_px", "Popping along the flight", "popping P99.9, px",
                    true)});
    if (!drawn) {
        page.not_measured("no cell is ok");
        return;
    }
    page.paragraph(fmt::format("Of each frame the median over the repetitions.{}",
                               any_has(set, of<&Cell::truth_frames>)
                                   ? " Error and popping are measured at every n-th frame; a "
                                     "method without popping there stands still but for the camera."
                                   : ""),
                   "note");
}

void add_map(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Flight path", set.id + "-map");
    const results::FlightRecord* flight = set.flight;
    if (flight == nullptr || flight->positions.empty()) {
        page.not_measured("these results hold no flights/" + set.scenario +
                          ".json (they are of an older lodbench, or no cell is ok)");
        return;
    }
    const MapFrame map = frame_of(*flight);
    const glm::dvec2 size = (map.high - map.low) * map.scale;
    const glm::dvec2 corner = map.place({flight->low.x, flight->high.y, 0});
    const glm::dvec2 terrain = (flight->high - flight->low) * map.scale;
    const std::string picture =
        flight->hillshade.empty() ? "" : page.pictures().embed(flight->hillshade);
    std::string svg = fmt::format(
        "<figure class=\"map\"><svg viewBox=\"-8 -8 {:.0f} {:.0f}\" role=\"img\" aria-label=\"The "
        "flight over the terrain from above\">\n<rect class=\"ground\" width=\"{:.1f}\" "
        "height=\"{:.1f}\"/>\n",
        size.x + 16, size.y + 44, size.x, size.y);
    svg +=
        fmt::format("<svg width=\"{0:.1f}\" height=\"{1:.1f}\" viewBox=\"0 0 {0:.1f} {1:.1f}\">\n",
                    size.x, size.y);
    if (!picture.empty()) {
        svg += fmt::format(
            "<image href=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
            "height=\"{:.1f}\" preserveAspectRatio=\"none\"/>\n",
            picture, corner.x, corner.y, terrain.x, terrain.y);
    }
    svg += "</svg>\n";
    svg += path_svg(*flight, map) + views_svg(*flight, map);
    svg += worst_svg(data, set, map);
    // A bar of a round length, a fifth of the map or less.
    const double extent = size.x / map.scale;
    double length = picture::nice_scale(extent / 5);
    if (length > extent / 3) length /= 2;
    svg += fmt::format(
        "<path class=\"scale-bar\" d=\"M0 {0:.1f}v6h{1:.1f}v-6\"/><text x=\"{2:.1f}\" "
        "y=\"{3:.1f}\">{4}</text>\n</svg>\n",
        size.y + 12, length * map.scale, length * map.scale + 8, size.y + 22,
        length >= 1000 ? fmt::format("{:g} km", length / 1000) : fmt::format("{:g} m", length));
    page.raw(svg);
    page.raw(fmt::format(
        "<figcaption>{} frames over a terrain of {} × {} samples, {:g} × {:g} m apart, "
        "{:.0f} to {:.0f} "
        "m high; shown is what lies around the flight. North is up. Circle: first "
        "frame; square: last; strokes: where the camera looks{}.</figcaption></figure>\n",
        flight->positions.size(), flight->rows, flight->columns, flight->spacing.x,
        flight->spacing.y, flight->min_height, flight->max_height,
        any_has(set, of<&Cell::truth_frames>) ? "; triangles: where each method's worst pixel was"
                                              : ""));
}

}  // namespace lodbench::report::html
