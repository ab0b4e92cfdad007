#include "extremes/flight.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "measure/drawn_surface.h"
#include "run/frame_measurer.h"
#include "run/stage.h"
#include "scenario/camera_track.h"
#include "terrain/open_terrain.h"

namespace lodbench::extremes {
namespace {

constexpr double kPositionStep = 0x1p-20;  // metres

bool same_bits(const glm::vec3& a, const glm::vec3& b) {
    using Bits = std::array<std::uint32_t, 3>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

/// Greatest distance between the surfaces at the samples, in metres of the world as it is;
/// infinite where one covers a sample and the other does not.
double moved_at_samples(const measure::CapturedSurface& original,
                        const measure::CapturedSurface& copy, const World& world,
                        const World& changed_world, double scale) {
    const auto displacements = [](measure::CapturedSurface surface, const World& in) {
        std::vector<float> result(in.terrain->samples().size());
        measure::DrawnSurface(std::move(surface), in.terrain->info())
            .displacements(in.terrain->samples(), result);
        return result;
    };
    const std::vector<float> before = displacements(original, world);
    const std::vector<float> after = displacements(copy, changed_world);
    double greatest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const bool covered = !std::isnan(before[i]);
        if (covered != !std::isnan(after[i])) return std::numeric_limits<double>::infinity();
        if (covered) {
            greatest = std::max(greatest, std::abs(double(after[i]) / scale - double(before[i])));
        }
    }
    return greatest;
}

/// What a flight drew, kept to be compared.
struct Drawn {
    std::vector<measure::CapturedSurface> surfaces;
    std::vector<std::vector<std::uint8_t>> images;
};

class ProbeFlight {
public:
    ProbeFlight(const Probe& probe, const scenario::Scenario& scenario, run::VitalSigns& signs,
                results::ExtremesFigures& figures)
        : probe_(probe), scenario_(scenario), signs_(signs), figures_(figures) {}

    /// The flight that is measured. Keeps what it drew where `keep`.
    void fly_measured(const World& world, Drawn* keep);
    /// The same method in the world as it is, for what it draws alone.
    [[nodiscard]] Drawn fly_plain(const World& world);
    [[nodiscard]] std::string device() const { return device_; }

private:
    void open(const World& world);
    void select(const World& world, std::size_t frame);
    void measure_frame(std::size_t frame, measure::CapturedSurface& surface);
    void note_triangles(std::uint64_t count);
    void summarize(const World& world);
    [[nodiscard]] bool repeats(const World& world, std::size_t frame,
                               const measure::CapturedSurface& surface);

    const Probe& probe_;
    const scenario::Scenario& scenario_;
    run::VitalSigns& signs_;
    results::ExtremesFigures& figures_;
    std::unique_ptr<run::Stage> stage_;
    std::unique_ptr<run::FrameMeasurer> measurer_;
    std::vector<double> rounding_m_;  ///< of each frame
    std::string device_;
};

void ProbeFlight::open(const World& world) {
    stage_ = std::make_unique<run::Stage>(run::StageSetup{.terrain = world.terrain,
                                                          .plugin = probe_.method.plugin,
                                                          .method = probe_.method.id,
                                                          .settings = probe_.settings,
                                                          .device = probe_.device},
                                          signs_);
    stage_->check_state(true);
    device_ = stage_->context().description();
    stage_->prepare();
    stage_->upload();
    stage_->resize(scenario_.viewport);
}

void ProbeFlight::select(const World& world, std::size_t frame) {
    signs_.frame = int(frame);
    signs_.beats.fetch_add(1, std::memory_order_relaxed);
    stage_->select(world.cameras[frame], world.clocks[frame]);
    stage_->settle();
    stage_->pause_background();
}

void ProbeFlight::note_triangles(std::uint64_t count) {
    figures_.triangles_min = std::min(figures_.triangles_min.value_or(count), count);
    figures_.triangles_max = std::max(figures_.triangles_max.value_or(count), count);
}

/// Selected once more with the same camera: the same triangles in the same order.
bool ProbeFlight::repeats(const World& world, std::size_t frame,
                          const measure::CapturedSurface& surface) {
    stage_->resume_background();
    select(world, frame);
    const measure::CapturedSurface again = stage_->capture();
    return std::ranges::equal(surface.vertices, again.vertices, same_bits);
}

void ProbeFlight::measure_frame(std::size_t frame, measure::CapturedSurface& surface) {
    double reach = 1;
    for (const glm::vec3& v : surface.vertices) {
        for (const double part : {double(v.x), double(v.y), double(v.z)}) {
            if (std::isfinite(part)) reach = std::max(reach, std::abs(part));
        }
    }
    rounding_m_.push_back(measure::DrawnSurface::kRoundingUnits * 0x1p-24 * reach);
    if (!scenario_.measure.truth || figures_.not_finite.value_or(0) > 0) return;
    results::FrameRecord record;
    record.triangles = surface.triangle_count();
    measurer_->take(int(frame), record, nullptr);
    measurer_->measure(record);
    figures_.pixels = figures_.pixels.value_or(0) + std::uint64_t(scenario_.viewport.width) *
                                                        std::uint64_t(scenario_.viewport.height);
}

void ProbeFlight::fly_measured(const World& world, Drawn* keep) {
    open(world);
    if (const std::string& bound = stage_->method().claimed_bound; !bound.empty()) {
        figures_.claimed_px = stage_->params().real(bound);
    }
    measurer_ = std::make_unique<run::FrameMeasurer>(
        *stage_, figures_.claimed_px,
        scenario_.measure.truth ? std::shared_ptr<const terrain::WholeTerrain>(world.terrain)
                                : nullptr);
    figures_.frames = 0;
    figures_.not_finite = figures_.unrepeated = 0;
    for (std::size_t frame = 0; frame < world.cameras.size(); ++frame) {
        select(world, frame);
        stage_->draw_picture();
        std::vector<std::uint8_t> image = keep ? stage_->read_color() : std::vector<std::uint8_t>();
        measure::CapturedSurface surface = stage_->capture();
        note_triangles(surface.triangle_count());
        *figures_.not_finite += measure::nonfinite_count(surface);
        measure_frame(frame, surface);
        if (!repeats(world, frame, surface)) ++*figures_.unrepeated;
        stage_->resume_background();
        ++*figures_.frames;
        if (keep == nullptr) continue;
        keep->surfaces.push_back(std::move(surface));
        keep->images.push_back(std::move(image));
    }
    if (scenario_.measure.truth && *figures_.not_finite == 0) summarize(world);
    measurer_.reset();
    stage_->release();
    stage_.reset();
}

void ProbeFlight::summarize(const World& world) {
    results::CellRecord cell;
    measurer_->finish(cell);
    if (cell.crack_pixels) figures_.crack_pixels = cell.crack_pixels->total;
    figures_.uncovered_samples = cell.uncovered_samples;
    if (const auto& screen = cell.screen_error_px) {
        figures_.samples = screen->count;
        figures_.screen_max_px = screen->max_covered;
        figures_.screen_p999_px = screen->p999;
        if (screen->worst && screen->count > 0) {
            const measure::WorstPlace& worst = *screen->worst;
            figures_.worst_frame = worst.frame;
            figures_.worst_row = worst.row;
            figures_.worst_column = worst.column;
            const Camera& camera = world.cameras[std::size_t(worst.frame)];
            float height = 0;
            world.terrain->read({worst.row, worst.column, 1, 1}, {&height, 1});
            const glm::dvec3 sample(world.terrain->info().position(worst.row, worst.column),
                                    height);
            const double depth =
                std::max(camera.near_plane, glm::dot(sample - camera.position, camera.forward()));
            figures_.rounding_px = camera.lambda() * rounding_m_[std::size_t(worst.frame)] / depth;
        }
    }
    if (cell.pixel_error_px) figures_.pixel_p999_px = cell.pixel_error_px->p999;
    if (!probe_.picture.empty()) measurer_->write_picture(probe_.picture, probe_.method.id);
}

Drawn ProbeFlight::fly_plain(const World& world) {
    open(world);
    Drawn drawn;
    for (std::size_t frame = 0; frame < world.cameras.size(); ++frame) {
        select(world, frame);
        stage_->draw_picture();
        drawn.images.push_back(stage_->read_color());
        drawn.surfaces.push_back(stage_->capture());
        stage_->resume_background();
    }
    stage_->release();
    stage_.reset();
    return drawn;
}

void compare_images(const std::vector<std::uint8_t>& original,
                    const std::vector<std::uint8_t>& copy, results::ExtremesFigures& figures) {
    for (std::size_t pixel = 0; pixel + 2 < original.size(); pixel += 3) {
        int levels = 0;
        for (std::size_t i = pixel; i < pixel + 3; ++i) {
            levels = std::max(levels, std::abs(int(original[i]) - int(copy[i])));
        }
        figures.image_levels = std::max(figures.image_levels.value_or(0), levels);
        if (levels > 1) ++*figures.changed_pixels;
    }
}

void compare(const Drawn& original, const Drawn& copy, const World& world,
             const World& changed_world, double scale, results::ExtremesFigures& figures) {
    figures.changed_triangles = figures.compared_triangles = figures.changed_pixels = 0;
    figures.image_levels = 0;
    figures.moved_m = 0;
    for (std::size_t frame = 0; frame < original.surfaces.size(); ++frame) {
        const SurfaceChange change = compare_surfaces(
            original.surfaces[frame], copy.surfaces[frame], world, changed_world, scale);
        *figures.changed_triangles += change.triangles;
        *figures.compared_triangles += original.surfaces[frame].triangle_count();
        if (change.moved_m > *figures.moved_m) {
            figures.moved_m = change.moved_m;
            figures.changed_frame = int(frame);
        }
        compare_images(original.images[frame], copy.images[frame], figures);
    }
}

}  // namespace

World make_world(const scenario::Scenario& scenario) {
    World world;
    world.terrain = terrain::whole_field(*terrain::open_terrain(scenario.terrain));
    const scenario::CameraTrack track(scenario, *world.terrain);
    for (int frame = 0; frame < scenario.frames; ++frame) {
        Camera camera = track.camera(frame);
        camera.position = glm::round(camera.position / kPositionStep) * kPositionStep;
        world.cameras.push_back(camera);
        world.clocks.push_back(track.clock(frame));
    }
    return world;
}

World changed(const World& world, const WorldChange& change) {
    World copy = world;
    TerrainInfo info = world.terrain->info();
    info.origin = info.origin * change.scale + change.shift;
    info.spacing *= change.scale;
    std::vector<float> heights(world.terrain->samples().begin(), world.terrain->samples().end());
    for (float& height : heights) height = float(double(height) * change.scale);
    copy.terrain = std::make_shared<const terrain::HeightField>(info, std::move(heights));
    for (Camera& camera : copy.cameras) {
        camera.position = camera.position * change.scale + glm::dvec3(change.shift, 0);
        camera.near_plane *= change.scale;
    }
    return copy;
}

SurfaceChange compare_surfaces(const measure::CapturedSurface& original,
                               const measure::CapturedSurface& copy, const World& world,
                               const World& changed_world, double scale) {
    SurfaceChange change;
    const auto count = std::min(original.triangle_count(), copy.triangle_count());
    change.triangles = std::max(original.triangle_count(), copy.triangle_count()) - count;
    double by_vertices = change.triangles == 0 ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t triangle = 0; triangle < count; ++triangle) {
        bool same = true;
        for (std::size_t v = 3 * triangle; v < 3 * triangle + 3; ++v) {
            const glm::dvec3 expected = glm::dvec3(original.vertices[v]) * scale;
            same = same && same_bits(copy.vertices[v], glm::vec3(expected));
            by_vertices =
                std::max(by_vertices, glm::length(glm::dvec3(copy.vertices[v]) - expected) / scale);
        }
        change.triangles += !same;
    }
    change.moved_m = by_vertices;
    // Far apart, they may be other triangles, or in another order: what counts is the surface that
    // all of them make.
    constexpr double kSameVertex = 1e-3;
    if (by_vertices > kSameVertex) {
        change.moved_m =
            std::min(by_vertices, moved_at_samples(original, copy, world, changed_world, scale));
    }
    return change;
}

void fly_here(const Probe& probe, const scenario::Scenario& scenario, run::VitalSigns& signs,
              ProbeOutcome& outcome) {
    signs.enter(run::Call::load_terrain);
    const World world = make_world(scenario);
    outcome.terrain = world.terrain->info().name;
    outcome.terrain_checksum = world.terrain->info().checksum;
    signs.enter(run::Call::start);
    ProbeFlight flight(probe, scenario, signs, outcome.figures);
    if (!probe.world.any()) {
        flight.fly_measured(world, nullptr);
        outcome.device = flight.device();
        return;
    }
    const World changed_world = changed(world, probe.world);
    const Drawn original = flight.fly_plain(world);
    Drawn copy;
    flight.fly_measured(changed_world, &copy);
    outcome.device = flight.device();
    if (*outcome.figures.not_finite > 0) return;
    signs.enter(run::Call::none);
    compare(original, copy, world, changed_world, probe.world.scale, outcome.figures);
}

}  // namespace lodbench::extremes
