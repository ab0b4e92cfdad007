#include "measure/pixel_errors.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "api/error.h"
#include "measure/pixel_projection.h"

namespace lodbench::measure {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPositionRounding = DrawnSurface::kRoundingUnits / 16777216;  // 2^-24
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// What a pixel shows, the reference's doubtful ones set to what was drawn.
struct Shows {
    bool drawn = false;
    bool reference = false;
};

class PixelMeter {
public:
    PixelMeter(const ReferenceTerrain& terrain, const DrawnSurface& surface, const Camera& camera,
               std::span<const ReferenceHit> hits, std::span<const float> depth)
        : terrain_(terrain),
          surface_(surface),
          hits_(hits),
          pixels_(camera),
          near_(camera.near_plane),
          depth_(depth),
          width_(std::size_t(camera.viewport.width)),
          has_skirts_(surface.skirt_triangle_count() > 0) {}

    struct Row {
        ErrorBatch errors;
        std::uint64_t cracks = 0, skirts = 0, silhouettes = 0, clipped = 0, unjudged = 0;
        std::uint64_t undecided = 0;
    };

    void measure_row(std::size_t y, double bound, ErrorPool& pool, PixelErrors& errors,
                     std::vector<Shows>& shows, Row& row) const {
        for (std::size_t x = 0; x < width_; ++x) {
            const std::size_t index = y * width_ + x;
            const double drawn_depth =
                depth_[index] > 0 ? near_ / double(depth_[index]) : kInfinity;
            std::uint8_t mark = 0;
            if (has_skirts_ && drawn_depth < kInfinity && shows_skirt(x, y, drawn_depth)) {
                mark |= kSkirtMark;
                ++row.skirts;
            }
            errors.drawn_px[index] = (mark & kSkirtMark) != 0 || drawn_depth == kInfinity
                                         ? kNothing
                                         : drawn_error(x, y, drawn_depth, row);
            const ReferenceHit& hit = hits_[index];
            errors.reference_px[index] =
                hit.certain < kInfinity ? reference_error(x, y, hit.certain, row) : kNothing;
            for (const float px : {errors.drawn_px[index], errors.reference_px[index]}) {
                if (std::isnan(px)) continue;
                pool.tally(row.errors, px, bound);
            }
            shows[index].drawn = drawn_depth < kInfinity;
            shows[index].reference = reference_shows(x, y, hit, shows[index].drawn);
            if (shows[index].drawn != shows[index].reference) {
                mark |= kSilhouetteMark;
                ++row.silhouettes;
            }
            if ((mark & kSkirtMark) == 0 && passes_a_crack(x, y, drawn_depth)) {
                if (surface_.passes_below(pixels_.eye(), ray(x, y), near_, near_)) {
                    ++row.unjudged;
                } else {
                    mark |= kCrackMark;
                    ++row.cracks;
                }
            }
            errors.marks[index] = mark;
        }
    }

private:
    // The centre first: the pixel's own ray.
    static constexpr std::array<glm::dvec2, 5> kShifts = {
        {{0, 0}, {0, -kSlackPx}, {0, kSlackPx}, {-kSlackPx, 0}, {kSlackPx, 0}}};

    [[nodiscard]] glm::dvec3 ray(std::size_t x, std::size_t y, glm::dvec2 shift = {0, 0}) const {
        return pixels_.direction(double(x) + 0.5 + shift.x, double(y) + 0.5 + shift.y);
    }

    [[nodiscard]] bool inside(const glm::dvec3& point) const {
        const glm::dvec2 low = terrain_.info().extent_min();
        const glm::dvec2 high = terrain_.info().extent_max();
        return point.x >= low.x && point.x <= high.x && point.y >= low.y && point.y <= high.y;
    }

    /// A point on the border may have been rounded to either side of it.
    [[nodiscard]] glm::dvec2 on_extent(const glm::dvec3& point) const {
        return glm::clamp(glm::dvec2(point), terrain_.info().extent_min(),
                          terrain_.info().extent_max());
    }

    /// From a point at `place` to the true interval above or below it, in pixels, less what the
    /// rounding of captured positions makes of it on steep ground: see the header.
    [[nodiscard]] float distance_to_truth(const glm::dvec3& point, const glm::dvec2& place,
                                          const DrawnSurface::Rounding& rounding, Row& row) const {
        const HeightInterval truth = terrain_.interval(place);
        if (point.z >= truth.low && point.z <= truth.high) return 0;
        PixelProjection::Distance distance = distance_to(truth, point);
        if (distance.px > kSettledPx) {
            HeightInterval around = terrain_.interval_within(place, rounding.plan);
            around = {around.low - rounding.height, around.high + rounding.height};
            const PixelProjection::Distance least = distance_to(around, point);
            if (distance.px - least.px > kRoundingPx) distance = least;
        }
        if (distance.clipped) ++row.clipped;
        return float(distance.px);
    }

    [[nodiscard]] PixelProjection::Distance distance_to(const HeightInterval& heights,
                                                        const glm::dvec3& point) const {
        const double nearest = std::clamp(point.z, heights.low, heights.high);
        return pixels_.distance(pixels_.local({point.x, point.y, nearest}), pixels_.local(point));
    }

    /// NaN where the depth cannot tell.
    [[nodiscard]] float drawn_error(std::size_t x, std::size_t y, double depth, Row& row) const {
        glm::dvec3 point = pixels_.eye() + ray(x, y) * depth;
        DrawnSurface::Look surface = surface_.look(on_extent(point));
        // As its error will be measured: straight up or down, also where it lies beyond the border.
        if (!surface.height ||
            pixels_between({point.x, point.y, *surface.height}, point) > kSettledPx) {
            const Slack slack = slack_of(x, y, depth);
            if (const auto drawn = point_on_surface(x, y, depth, slack)) {
                point = *drawn;
                surface = surface_.look(on_extent(point));
            } else if (error_is_uncertain(ray(x, y), depth, slack, point)) {
                ++row.undecided;
                return kNothing;
            }
        }
        return distance_to_truth(point, on_extent(point), surface.rounding, row);
    }

    /// By how much the rasteriser may have drawn beside a pixel's ray and its depth.
    struct Slack {
        double px;
        double aside, along;  ///< metres
    };
    [[nodiscard]] Slack slack_of(std::size_t x, std::size_t y, double depth) const {
        const DrawnSurface::Reach reach = surface_.reach_beside(
            pixels_.eye(), ray(x, y), depth * (1 - kSliverSlack), depth * (1 + kSliverSlack),
            pixels_.tangent(1), pixels_.forward());
        const double moved = kPositionRounding * reach.largest;
        const double px = kSlackPx + moved / (depth * pixels_.tangent(1));
        const double interpolated =
            kInterpolation * depth / std::clamp(reach.nearest, near_, depth);
        const double along = std::max(kDepthSlack, interpolated) * depth + moved;
        return {px, pixels_.tangent(px) * depth, along};
    }

    /// Whether the true height below or above a point, and so its error, is uncertain by more than
    /// kJudgedPx to either side for the slack of its place.
    [[nodiscard]] bool error_is_uncertain(const glm::dvec3& direction, double depth,
                                          const Slack& slack, const glm::dvec3& point) const {
        const glm::dvec2 place = on_extent(point);
        if (slack.along >= kSliverSlack * depth) return true;  // farther than l_f is looked for
        const double radius = slack.along * glm::length(glm::dvec2(direction)) + slack.aside;
        const HeightInterval here = terrain_.interval(place);
        const HeightInterval around = terrain_.interval_within(place, radius);
        const double ground = ((around.high - around.low) - (here.high - here.low)) / 2;
        const double uncertain = ground + slack.along * std::abs(direction.z) + slack.aside;
        return pixels_between(point, point + glm::dvec3(0, 0, uncertain)) > kJudgedPx;
    }

    struct Meeting {
        glm::dvec2 shift;
        double depth;
    };

    /// Where a ray within the slack of the pixel's meets l_f at a depth; or nearest to it, where a
    /// sliver is near.
    [[nodiscard]] std::optional<glm::dvec3> point_on_surface(std::size_t x, std::size_t y,
                                                             double depth,
                                                             const Slack& slack) const {
        std::vector<Meeting> meetings;
        for (const glm::dvec2& direction : kShifts) {
            const glm::dvec2 shift = direction * (slack.px / kSlackPx);
            auto met =
                meets_surface(x, y, shift, depth, std::min(slack.along / depth, kSliverSlack));
            if (!met) met = meets_surface(x, y, shift, depth, kSliverSlack);
            if (met) meetings.push_back({shift, *met});
        }
        if (meetings.empty()) return std::nullopt;
        const auto off = [depth](const Meeting& met) { return std::abs(met.depth - depth); };
        const Meeting nearest = std::ranges::min(meetings, {}, off);
        if (off(nearest) > slack.along) {
            if (const auto between = point_between(x, y, meetings, depth, slack)) return between;
            if (!surface_.sliver_near(pixels_.eye(), ray(x, y), depth * (1 - kSliverSlack),
                                      depth * (1 + kSliverSlack), pixels_.tangent(kSlackPx),
                                      pixels_.tangent(kSlackPx))) {
                return std::nullopt;
            }
        }
        return pixels_.eye() + ray(x, y, nearest.shift) * nearest.depth;
    }

    /// Where rays meet l_f before and behind a depth: the point at which one between them meets it
    /// there. Nothing where l_f jumps from the one to the other.
    [[nodiscard]] std::optional<glm::dvec3> point_between(std::size_t x, std::size_t y,
                                                          const std::vector<Meeting>& meetings,
                                                          double depth, const Slack& slack) const {
        for (const Meeting& before : meetings) {
            for (const Meeting& behind : meetings) {
                if (before.depth >= depth || behind.depth <= depth) continue;
                glm::dvec2 low = before.shift, high = behind.shift;
                // To 2^-24 of the slack: what has a step left there is no face.
                for (int i = 0; i < 24; ++i) {
                    const glm::dvec2 middle = 0.5 * (low + high);
                    const auto met = meets_surface(x, y, middle, depth, kSliverSlack);
                    if (!met) break;
                    if (std::abs(*met - depth) <= slack.along) {
                        return pixels_.eye() + ray(x, y, middle) * *met;
                    }
                    (*met < depth ? low : high) = middle;
                }
            }
        }
        return std::nullopt;
    }

    /// The depth at which a ray beside the pixel's meets a triangle of l_f, about a depth.
    [[nodiscard]] std::optional<double> meets_surface(std::size_t x, std::size_t y,
                                                      const glm::dvec2& shift, double depth,
                                                      double slack) const {
        return surface_.meets_surface(pixels_.eye(), ray(x, y, shift), depth * (1 - slack),
                                      depth * (1 + slack));
    }

    [[nodiscard]] double pixels_between(const glm::dvec3& a, const glm::dvec3& b) const {
        return pixels_.distance(pixels_.local(a), pixels_.local(b)).px;
    }

    [[nodiscard]] float reference_error(std::size_t x, std::size_t y, double depth,
                                        Row& row) const {
        const glm::dvec3 point = pixels_.eye() + ray(x, y) * depth;
        const glm::dvec2 place = on_extent(point);
        const DrawnSurface::Look drawn = surface_.look(place);
        if (!drawn.height) return std::numeric_limits<float>::infinity();
        return distance_to_truth({place.x, place.y, *drawn.height}, place, drawn.rounding, row);
    }

    [[nodiscard]] bool reference_shows(std::size_t x, std::size_t y, const ReferenceHit& hit,
                                       bool drawn) const {
        const auto agrees = [drawn](const ReferenceHit& other) {
            return drawn ? other.possible < kInfinity : other.certain == kInfinity;
        };
        if (agrees(hit)) return drawn;
        for (std::size_t i = 1; i < kShifts.size(); ++i) {
            if (agrees(terrain_.cast(pixels_.eye(), ray(x, y, kShifts[i]), near_))) return drawn;
        }
        return !drawn;
    }

    /// A skirt stands where something was drawn, and what was drawn does not lie on l_f.
    [[nodiscard]] bool shows_skirt(std::size_t x, std::size_t y, double depth) const {
        const bool stands =
            std::any_of(kShifts.begin(), kShifts.end(), [&](const glm::dvec2& shift) {
                return surface_
                    .meets_skirt(pixels_.eye(), ray(x, y, shift), depth * (1 - kDepthSlack),
                                 depth * (1 + kDepthSlack))
                    .has_value();
            });
        if (!stands) return false;
        const glm::dvec3 point = pixels_.eye() + ray(x, y) * depth;
        const std::optional<double> surface = surface_.height(on_extent(point));
        return !surface || pixels_between({point.x, point.y, *surface}, point) > kSlackPx;
    }

    /// The ray and those around it all pass below l_f before what was drawn, which lies on another
    /// part of the surface or is sky, and came there over covered ground.
    [[nodiscard]] bool passes_a_crack(std::size_t x, std::size_t y, double depth) const {
        const double to = depth < kInfinity ? depth * (1 - kDepthSlack) : kInfinity;
        if (to <= near_) return false;
        // Nearly every pixel is cleared by the first, raised ray.
        for (std::size_t i = 1; i <= kShifts.size(); ++i) {
            const glm::dvec3 direction = ray(x, y, kShifts[i % kShifts.size()]);
            if (!surface_.passes_below(pixels_.eye(), direction, near_, to)) return false;
        }
        return came_over_covered_ground(ray(x, y), to) &&
               (depth == kInfinity || shows_surface(x, y, depth));
    }

    /// What was drawn lies on some triangle: its depth is not a sliver's.
    [[nodiscard]] bool shows_surface(std::size_t x, std::size_t y, double depth) const {
        return std::any_of(kShifts.begin(), kShifts.end(), [&](const glm::dvec2& shift) {
            return meets_surface(x, y, shift, depth, kDepthSlack).has_value();
        });
    }

    /// The ray passes below l_f in [near, to]: whether a triangle covers the ground just before the
    /// first place where it does. Otherwise it came through a hole in the ground, which is no
    /// crack.
    [[nodiscard]] bool came_over_covered_ground(const glm::dvec3& direction, double to) const {
        double above = near_;
        double under = to;
        if (under == kInfinity) {
            for (under = 2 * near_;
                 !surface_.passes_below(pixels_.eye(), direction, near_, under);) {
                under *= 2;
            }
        }
        // The least bound up to which it passes below, to a few units of the rounding that coverage
        // allows.
        while (under - above > 1e-8 * under) {
            const double middle = (above + under) / 2;
            (surface_.passes_below(pixels_.eye(), direction, near_, middle) ? under : above) =
                middle;
        }
        // Asked at several distances: the nearest lies within the rounding of a hole's edge where
        // the ray leaves it at a small angle, the farthest beyond a hole that is small.
        for (const double step_back : {1e-5, 1e-4, 1e-3}) {
            const glm::dvec3 before = pixels_.eye() + direction * (above * (1 - step_back));
            if (!inside(before) || !surface_.height(glm::dvec2(before))) return false;
        }
        return true;
    }

    const ReferenceTerrain& terrain_;
    const DrawnSurface& surface_;
    std::span<const ReferenceHit> hits_;
    PixelProjection pixels_;
    double near_;
    std::span<const float> depth_;
    std::size_t width_;
    bool has_skirts_;
};

/// First row of each column that shows terrain, as the field `Shows::*`; the height where none
/// does.
void measure_silhouette(const std::vector<Shows>& shows, std::size_t width, std::size_t height,
                        PixelErrors& errors) {
    double sum = 0;
    for (std::size_t x = 0; x < width; ++x) {
        const auto first_row = [&](bool Shows::*shown) {
            std::size_t y = 0;
            while (y < height && !(shows[y * width + x].*shown)) ++y;
            return double(y);
        };
        const double offset = std::abs(first_row(&Shows::drawn) - first_row(&Shows::reference));
        sum += offset;
        errors.silhouette_max = std::max(errors.silhouette_max, offset);
    }
    errors.silhouette_mean = sum / double(width);
}

}  // namespace

PixelErrors measure_pixels(const ReferenceTerrain& terrain, const DrawnSurface& surface,
                           const Camera& camera, std::span<const ReferenceHit> hits,
                           std::span<const float> depth, double bound, ErrorPool& pool) {
    const std::size_t width = std::size_t(camera.viewport.width);
    const std::size_t height = std::size_t(camera.viewport.height);
    if (depth.size() != width * height || hits.size() != depth.size()) {
        throw ContractError(fmt::format("measure_pixels: {} depths and {} hits, expected {} x {}",
                                        depth.size(), hits.size(), width, height));
    }
    PixelErrors errors;
    errors.drawn_px.resize(depth.size());
    errors.reference_px.resize(depth.size());
    errors.marks.resize(depth.size());
    std::vector<Shows> shows(depth.size());
    std::vector<PixelMeter::Row> rows(height);
    const PixelMeter meter(terrain, surface, camera, hits, depth);
    tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
        meter.measure_row(y, bound, pool, errors, shows, rows[y]);
        terrain.forget();
    });
    for (PixelMeter::Row& row : rows) {
        pool.add(row.errors);
        errors.crack_pixels += row.cracks;
        errors.skirt_pixels += row.skirts;
        errors.silhouette_pixels += row.silhouettes;
        errors.clipped += row.clipped;
        errors.unjudged_pixels += row.unjudged;
        errors.undecided_pixels += row.undecided;
    }
    measure_silhouette(shows, width, height, errors);
    return errors;
}

}  // namespace lodbench::measure
