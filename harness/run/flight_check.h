#pragma once
// Flights that measure nothing, or something else than they seem to: seen from the cameras and the
// terrain alone, whatever the methods draw.

#include <optional>
#include <string>
#include <vector>

#include "api/camera.h"
#include "api/terrain.h"

namespace lodbench::run {

class FlightCheck {
public:
    /// Share of a flight's frames with the view of the frame before from which on it is said.
    static constexpr double kLongStand = 0.5;

    /// The terrain must outlive this object.
    explicit FlightCheck(const Terrain& terrain) : terrain_(terrain) {}

    /// The camera of the next frame. Reads no more of a terrain on disk than a few of its tiles.
    void add(const Camera& camera);

    /// In words: of the flight of `name`, the scenario's, and of voids in what it flies over.
    [[nodiscard]] std::vector<std::string> warnings(const std::string& name) const;

private:
    /// Frames that have some property.
    struct Frames {
        int count = 0;
        int first = 0;
        void add(int frame) {
            if (count++ == 0) first = frame;
        }
        /// "5 of 120 frames, the first of them frame 7", "all 120 frames", "its one frame".
        [[nodiscard]] std::string words(int frames) const;
    };

    /// Metres by which a position is below the ground; 0 or less where it is not, or not over the
    /// terrain.
    [[nodiscard]] double depth_below_ground(const glm::dvec3& position) const;
    /// Whether the box of some cell of the grid reaches into the view. True, too, where more tiles
    /// reach into it than are looked at.
    [[nodiscard]] bool sees_terrain(const Camera& camera);

    const Terrain& terrain_;
    std::optional<Camera> before_;
    TileId seen_;  ///< the tile that was seen last: most often it is again
    std::vector<float> samples_;
    std::optional<TileId> held_;  ///< whose samples these are
    int frames_ = 0;
    Frames blind_, below_, standing_;
    double deepest_ = 0;
    int deepest_frame_ = 0;
};

}  // namespace lodbench::run
