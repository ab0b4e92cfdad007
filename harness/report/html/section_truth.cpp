// What the pictures really show: bounds that hold or do not, popping, and each method's worst
// frame.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/figures.h"
#include "report/html/sections.h"
#include "report/html/text.h"

namespace lodbench::report::html {

using namespace results::figures;

namespace {

constexpr const char* kNoTruth = "the truth was left out (--no-truth), or every cell failed";

}  // namespace

void add_honesty(Page& page, const ReportData& data, const ResultSet& set) {
    page.heading(3, "Claimed bounds against measured error", set.id + "-bounds");
    Series series{"bound honesty"};
    std::vector<std::size_t> claiming;
    std::string silent;
    for (const std::size_t i : choose_groups(set, kMostBars)) {
        const results::CellGroup& group = set.groups[i];
        const auto honesty = figure(group, of<&Cell::bound_honesty>);
        if (!honesty) {
            silent += (silent.empty() ? "" : ", ") + group.label;
            continue;
        }
        series.marks.push_back({*honesty, double(claiming.size())});
        claiming.push_back(i);
    }
    Plot plot = bars_of(data, set, "honesty", "Greatest screen error over claimed bound",
                        "measured / claimed; above 1 the claim does not hold", claiming);
    plot.reference = 1;
    const bool drawn = !series.marks.empty();
    plot.series.push_back(std::move(series));
    if (drawn && !silent.empty()) {
        plot.notes.push_back("No bound is claimed, or none was measured, for: " + silent + ".");
    }
    if (!drawn || !page.plots({plot}, true)) {
        page.not_measured("no method here claims a bound, or the truth was left out");
    }
    static constexpr FigureColumn kMeasures[] = {
        {"claimed, px", of<&Cell::claimed_px>, 3},
        {"measured max, px", of<&Cell::screen_error_px, &ErrorFigures::max>, 3},
        {"P99.9, px", of<&Cell::screen_error_px, &ErrorFigures::p999>, 3},
        {"P99, px", of<&Cell::screen_error_px, &ErrorFigures::p99>, 3},
        {"RMS, px", of<&Cell::screen_error_px, &ErrorFigures::rms>, 3},
        {"share over the bound", of<&Cell::screen_error_px, &ErrorFigures::over_tau>, 5},
        {"measured / claimed", of<&Cell::bound_honesty>, 3},
        {"seen by the camera, max, px", of<&Cell::visible_error_px, &ErrorFigures::max>, 3}};
    page.table(
        figure_table(set, "bounds", "Screen error and claimed bounds, " + set.title, kMeasures));
}

void add_popping(Page& page, const ResultSet& set) {
    page.heading(3, "Popping, cracks and the picture", set.id + "-picture");
    static constexpr FigureColumn kMeasures[] = {
        {"popping max, px", of<&Cell::popping_px, &PoppingFigures::max>, 3},
        {"popping P99.9, px", of<&Cell::popping_px, &PoppingFigures::p999>, 3},
        {"samples that pop over 1 px", of<&Cell::popping_px, &PoppingFigures::over_1px>, 0},
        {"crack pixels", of<&Cell::crack_pixels, &TotalAndMax::total>, 0},
        {"skirt pixels", of<&Cell::skirt_pixels, &TotalAndMax::total>, 0},
        {"uncovered samples", of<&Cell::uncovered_samples>, 0},
        {"silhouette max, px", of<&Cell::silhouette_px, &SilhouetteFigures::max>, 2},
        {"height RMS, m, mean", of<&Cell::height_rmse_m, &HeightFigures::mean>, 3},
        {"height RMS of the whole, m, mean",
         of<&Cell::height_rmse_whole_m, &WholeHeightFigures::mean>, 3},
        {"PSNR, dB", of<&Cell::image, &PictureFigures::psnr_db>, 2},
        {"SSIM", of<&Cell::image, &PictureFigures::ssim>, 5}};
    if (!any_has(set, of<&Cell::truth_frames>)) page.not_measured(kNoTruth);
    page.table(figure_table(set, "picture", "What the pictures show, " + set.title, kMeasures));
    page.paragraph(
        "PSNR and SSIM compare shaded pictures with the full grid's. A surface without error that "
        "splits the cells along other diagonals is shaded otherwise: it has less than ∞ dB.",
        "note");
}

void add_worst_pictures(Page& page, const ResultSet& set) {
    page.heading(3, "Worst frames", set.id + "-worst");
    const std::size_t left_out_before = page.pictures().left_out();
    std::string html;
    for (const std::size_t i : choose_groups(set, set.groups.size())) {
        const results::CellGroup& group = set.groups[i];
        for (const results::CellRecord* cell : group.good) {
            if (!cell->pixel_error_px) continue;  // of later repetitions there is none
            const std::string uri =
                page.pictures().embed(set.folder->path / "shots" / (cell->cell + "__worst.png"));
            if (uri.empty()) continue;
            const std::string words = fmt::format(
                "{}: pixel error P99.9 {} px over the flight", group.label,
                readable(figure(group, of<&Cell::pixel_error_px, &ErrorFigures::p999>), 3));
            html += fmt::format(
                "<figure class=\"picture\"><figcaption>{0}</figcaption><div class=\"scroll\" "
                "role=\"region\" tabindex=\"0\" aria-label=\"{0}\"><img loading=\"lazy\" "
                "decoding=\"async\" src=\"{1}\" alt=\"The worst frame of {2}: as drawn, as it "
                "should "
                "be, its error, and where on the terrain that is\"></div></figure>\n",
                escape(words), uri, escape(group.label));
        }
    }
    const std::size_t left_out = page.pictures().left_out() - left_out_before;
    if (html.empty() && left_out == 0) {
        page.not_measured("there is no picture of a worst frame (the truth was left out)");
        return;
    }
    page.paragraph(
        "Of each setting the worst of the measured frames: drawn, as it should be, the error of "
        "each "
        "pixel, and where on the terrain that is. Which frame it is stands above each picture.",
        "note");
    page.raw("<div class=\"pictures\">\n" + html + "</div>\n");
    if (left_out > 0) {
        page.paragraph(
            fmt::format("{} more pictures are left out, so that this page stays small: see "
                        "shots/ in {}.",
                        left_out, set.folder->name),
            "note");
    }
}

}  // namespace lodbench::report::html
