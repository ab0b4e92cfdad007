#pragma once
// A method over a small terrain in a context of its own, and cameras to fly it with.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "run/stage.h"

namespace lodbench::test {

/// Rolling hills, 100 m +- 60 m high, of waves longer than eight samples, so that a surface through
/// half of the samples is still close. World origin off zero, spacing different along the axes.
inline std::shared_ptr<const terrain::HeightField> hills(int rows, int columns) {
    TerrainInfo info;
    info.name = "hills";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {10, 12.5};
    info.origin = {512000.25, -3400.5};
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            heights.push_back(float(100 + 40 * std::sin(0.21 * column + 0.05 * row) +
                                    20 * std::cos(0.17 * row - 0.03 * column)));
        }
    }
    return std::make_shared<terrain::HeightField>(info, std::move(heights));
}

inline std::shared_ptr<const terrain::HeightField> flat(int rows, int columns, float height) {
    TerrainInfo info;
    info.name = "flat";
    info.rows = rows;
    info.columns = columns;
    info.spacing = {10, 10};
    return std::make_shared<terrain::HeightField>(
        info, std::vector<float>(std::size_t(rows) * std::size_t(columns), height));
}

inline std::shared_ptr<const terrain::HeightField> puget_sound() {
    terrain::TerrainSource source;
    source.file = LODBENCH_SOURCE_DIR "/scenarios/terrain/puget_sound_1025_160m.png";
    source.spacing_x = source.spacing_y = 160;
    source.vertical_scale = 0.1;
    return terrain::load_terrain(source);
}

inline constexpr double kDegree = std::numbers::pi / 180;

/// Angles in degrees: heading clockwise from north, pitch upward, roll clockwise.
inline Camera camera_at(const glm::dvec3& position, double heading, double pitch, double roll = 0,
                        double vertical_fov = 60) {
    const double h = heading * kDegree, p = pitch * kDegree;
    const glm::dvec3 ahead(std::sin(h), std::cos(h), 0);
    const glm::dvec3 forward = std::cos(p) * ahead + glm::dvec3(0, 0, std::sin(p));
    const glm::dvec3 up = -std::sin(p) * ahead + glm::dvec3(0, 0, std::cos(p));
    Camera camera;
    camera.position = position;
    camera.orientation =
        Camera::look(forward, up) * glm::angleAxis(-roll * kDegree, glm::dvec3(0, 0, 1));
    camera.vertical_fov = vertical_fov * kDegree;
    camera.viewport = {160, 120};
    return camera;
}

/// The whole life of a method: created, prepared and uploaded here, released at the end.
class Flight {
public:
    Flight(const std::shared_ptr<const Terrain>& terrain, const std::string& plugin,
           const std::string& method,
           const std::vector<std::pair<std::string, std::string>>& settings = {})
        : stage_(
              {terrain, std::string(LODBENCH_PLUGINS) + "/" + plugin + ".so", method, settings, ""},
              signs_) {
        stage_.check_state(true);
        stage_.prepare();
        stage_.upload();
    }
    ~Flight() { stage_.release(); }
    Flight(const Flight&) = delete;
    Flight& operator=(const Flight&) = delete;

    [[nodiscard]] measure::CapturedSurface surface(const Camera& camera) {
        select(camera);
        return stage_.capture();
    }
    void select(const Camera& camera) {
        stage_.resize(camera.viewport);
        stage_.select(camera, {});
    }
    [[nodiscard]] double counter(const std::string& name) {
        for (const auto& [key, value] : stage_.counters()) {
            if (key == name) return value;
        }
        throw ContractError("no counter " + name);
    }
    [[nodiscard]] run::Stage& stage() { return stage_; }

private:
    run::VitalSigns signs_;
    run::Stage stage_;
};

}  // namespace lodbench::test
