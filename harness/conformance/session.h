#pragma once
// What the checks share: small terrains, cameras from a seed, and a stage that is ready to fly.

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "conformance/check.h"
#include "run/stage.h"

namespace lodbench::conformance {

using TerrainPointer = std::shared_ptr<const terrain::HeightField>;

/// A synthetic terrain by name, 10 m between its samples, seed 1, its south-west corner at
/// `origin`.
[[nodiscard]] TerrainPointer make_terrain(const std::string& form, int rows, int columns,
                                          const glm::dvec2& origin = {0, 0});
/// Where most checks fly: ridged, 129 x 129.
[[nodiscard]] TerrainPointer ridged_terrain();

inline constexpr Viewport kViewport{320, 240};

/// Equal on every machine and with every standard library, as its distributions are not.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    [[nodiscard]] double between(double low, double high) {
        return low + (high - low) * (double(engine_() >> 11) * 0x1p-53);
    }
    [[nodiscard]] int integer(int low, int high) {  ///< both inclusive
        return low + int(engine_() % std::uint64_t(high - low + 1));
    }

private:
    std::mt19937_64 engine_;
};

/// Metres above the highest sample below which a camera over this terrain sees detail: a quarter of
/// the extent's longer side.
[[nodiscard]] double low_flight(const TerrainInfo& terrain);

/// A camera over (or near) the terrain, looking somewhat downward.
[[nodiscard]] Camera random_camera(Random& random, const TerrainInfo& terrain);

/// `frames` cameras: a smooth flight with one jump, as methods may keep state from frame to frame.
[[nodiscard]] std::vector<Camera> random_flight(Random& random, const TerrainInfo& terrain,
                                                int frames);

/// A camera with a name for messages.
struct NamedCamera {
    std::string name;
    Camera camera;
};
/// Level, straight down, upward, rolled, on the ground, under it, far outside, at a corner, at a
/// sample.
[[nodiscard]] std::vector<NamedCamera> hard_cameras(const Terrain& terrain);

/// A stage that was prepared, uploaded and sized, and the few steps that the checks are made of.
class Session {
public:
    using Settings = std::vector<std::pair<std::string, std::string>>;
    /// `settings` are added to the subject's, and go before those of the same name.
    Session(const Subject& subject, TerrainPointer terrain, const Settings& settings = {},
            const Viewport& viewport = kViewport);

    [[nodiscard]] run::Stage& stage() { return *stage_; }
    [[nodiscard]] const TerrainInfo& terrain() const { return stage_->terrain().info(); }
    /// Selects and settles, as lockstep does.
    void select(const Camera& camera, int frame = 0);
    /// Selects without waiting for background work, as the timing replay does.
    void select_at_once(const Camera& camera, int frame);
    /// Draws the picture and returns its depth, row 0 the top.
    [[nodiscard]] std::vector<float> picture();
    /// The same through any view.
    [[nodiscard]] std::vector<float> depth_through(const View& view);
    /// Background work paused, as everywhere in the harness.
    [[nodiscard]] measure::CapturedSurface capture();
    /// The claimed bound in pixels; nothing where none is claimed.
    [[nodiscard]] std::optional<double> claimed_px() const;
    /// GL_PRIMITIVES_GENERATED while the selection is drawn through `view`.
    [[nodiscard]] std::uint64_t triangles_through(const View& view);

private:
    std::shared_ptr<run::VitalSigns> signs_;
    std::unique_ptr<run::Stage> stage_;
};

/// The frame's time at 60 frames per second.
[[nodiscard]] Clock clock_of(int frame);

/// Pixels whose bits differ; throws PromiseBroken with `what` and the first such pixel when there
/// is one.
void require_same_depth(const std::vector<float>& before, const std::vector<float>& after,
                        const Viewport& viewport, const std::string& what);
/// The same for two captures, triangle for triangle.
void require_same_surface(const measure::CapturedSurface& before,
                          const measure::CapturedSurface& after, const std::string& what);
/// Throws PromiseBroken, naming `what`, where a captured vertex is NaN or infinite.
void require_finite(const measure::CapturedSurface& surface, const std::string& what);

}  // namespace lodbench::conformance
