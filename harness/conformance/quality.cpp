#include "conformance/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <variant>

#include "conformance/session.h"
#include "results/json.h"
#include "run/knob.h"

namespace lodbench::conformance {

namespace {

constexpr int kUsualSize = 257, kLargerSize = 513;  // samples an edge

TerrainPointer terrain_of(int size) {
    return make_terrain("ridged", size, size);
}

/// The knob's start where the subject has it.
std::optional<run::Knob> knob_of(const Subject& subject) {
    std::optional<run::Knob> knob = run::quality_knob(subject.method);
    if (!knob) return knob;
    const Params params = run::make_params(subject.method, subject.settings, "--set");
    const ParamValue& value = params.values().at(knob->name);
    knob->start = knob->integer ? double(std::get<std::int64_t>(value)) : std::get<double>(value);
    return knob;
}

/// From one end of the range to the other by way of the start, rising.
std::vector<double> steps_of(const run::Knob& knob) {
    constexpr int kPoints = 101;  // 50 doublings to either side: beyond any range
    std::vector<double> steps = run::sweep_values(knob, kPoints);
    for (const double end : {knob.minimum, knob.maximum}) steps.push_back(knob.admitted(end));
    std::ranges::sort(steps);
    steps.erase(std::ranges::unique(steps).begin(), steps.end());
    return steps;
}

/// Over the southern border, looking at all of it.
Camera overlooking(const TerrainInfo& terrain) {
    const glm::dvec2 middle = 0.5 * (terrain.extent_min() + terrain.extent_max());
    Camera camera;
    camera.viewport = kViewport;
    camera.position = {middle.x, terrain.extent_min().y, terrain.max_height + low_flight(terrain)};
    camera.orientation = Camera::look(glm::dvec3(middle, terrain.min_height) - camera.position);
    return camera;
}

class Finder {
public:
    Finder(const Subject& subject, int terrain_size, const run::Knob& knob)
        : subject_(subject),
          terrain_size_(terrain_size),
          terrain_(terrain_of(terrain_size)),
          knob_(knob),
          steps_(steps_of(knob)) {
        const double start = knob.admitted(knob.start);
        start_ = int(std::ranges::lower_bound(steps_, start) - steps_.begin());
    }

    /// False where the finest and the coarsest step draw the same.
    [[nodiscard]] bool leaves_something_out() { return triangles(coarse_) < triangles(finest_); }

    Qualities find() {
        const int finer = finer_direction();
        finest_ = finest_step(finer);
        coarse_ = coarse_step(-finer, triangles(finest_));
        Qualities found{.terrain_size = terrain_size_,
                        .given = quality(start_, ""),
                        .finest = quality(finest_, " (finest)"),
                        .coarse = quality(coarse_, " (coarse)")};
        found.given.settings.clear();  // to the bit as the subject has it, which steps are not
        return found;
    }

private:
    struct Looked {
        std::uint64_t triangles = 0;
        std::optional<double> claimed_px;
    };

    /// Each step is looked at once.
    const Looked& look(int step) {
        const auto known = looked_.find(step);
        if (known != looked_.end()) return known->second;
        Session session(subject_, terrain_, {{knob_.name, text(step)}});
        session.select(overlooking(terrain_->info()));
        const Looked found{session.stage().count_primitives(), session.claimed_px()};
        return looked_.emplace(step, found).first->second;
    }
    [[nodiscard]] std::uint64_t triangles(int step) { return look(step).triangles; }
    [[nodiscard]] std::string text(int step) const { return knob_.text(steps_[std::size_t(step)]); }
    [[nodiscard]] Quality quality(int step, const char* role) {
        return {.name = fmt::format("{} = {}{}", knob_.name, text(step), role),
                .settings = {{knob_.name, text(step)}},
                .claimed_px = look(step).claimed_px};
    }
    [[nodiscard]] int last(int direction) const {
        return direction < 0 ? 0 : int(steps_.size()) - 1;
    }

    /// -1 where less is finer: a bound in pixels, or what draws more triangles a step away.
    [[nodiscard]] int finer_direction() {
        if (knob_.name == subject_.method.claimed_bound) return -1;
        if (start_ > 0) return triangles(start_ - 1) > triangles(start_) ? -1 : 1;
        return start_ < last(1) && triangles(start_ + 1) < triangles(start_) ? -1 : 1;
    }

    [[nodiscard]] int finest_step(int finer) {
        const TerrainInfo& info = terrain_->info();
        const std::uint64_t most =
            kMostTriangles * 2 * std::uint64_t(info.rows - 1) * std::uint64_t(info.columns - 1);
        // A method with a bound stops at the terrain's own resolution; another may go on and on, so
        // that its end is approached.
        if (!subject_.method.claimed_bound.empty() && triangles(last(finer)) <= most) {
            return last(finer);
        }
        int step = start_;
        while (step != last(finer) && triangles(step + finer) <= most) step += finer;
        return step;
    }

    [[nodiscard]] int coarse_step(int coarser, std::uint64_t finest) {
        // Where even the end of the range leaves nothing out, the steps before it do not either.
        if (triangles(last(coarser)) >= finest) return last(coarser);
        int step = start_;
        while (step != last(coarser)) {
            step += coarser;
            if (4 * triangles(step) <= finest) break;
        }
        return step;
    }

    const Subject& subject_;
    int terrain_size_;
    TerrainPointer terrain_;
    run::Knob knob_;
    std::vector<double> steps_;
    int start_ = 0, finest_ = 0, coarse_ = 0;
    std::map<int, Looked> looked_;
};

Json::Value to_json(const Quality& quality) {
    Json::Value json;
    json["name"] = quality.name;
    json["settings"] = Json::arrayValue;
    for (const auto& [name, value] : quality.settings) {
        Json::Value& pair = json["settings"].append(Json::arrayValue);
        pair.append(name);
        pair.append(value);
    }
    // As text, for JSON's own numbers lose their last bits.
    if (quality.claimed_px) json["claimed_px"] = fmt::format("{}", *quality.claimed_px);
    return json;
}

Quality from_json(const Json::Value& json) {
    Quality quality{.name = json["name"].asString(), .settings = {}, .claimed_px = std::nullopt};
    for (const Json::Value& pair : json["settings"]) {
        quality.settings.emplace_back(pair[0].asString(), pair[1].asString());
    }
    if (json.isMember("claimed_px")) quality.claimed_px = std::stod(json["claimed_px"].asString());
    return quality;
}

}  // namespace

TerrainPointer Qualities::terrain() const {
    return terrain_of(terrain_size);
}

std::vector<Quality> Qualities::all() const {
    std::vector<Quality> qualities;
    if (coarse) qualities.push_back(*coarse);
    qualities.push_back(given);
    if (finest) qualities.push_back(*finest);
    return qualities;
}

Qualities find_qualities(const Subject& subject) {
    const auto knob = knob_of(subject);
    if (!knob) {
        Qualities only;
        only.terrain_size = kUsualSize;
        only.given.name = "default";
        return only;
    }
    Finder usual(subject, kUsualSize, *knob);
    const Qualities found = usual.find();
    if (usual.leaves_something_out()) return found;
    return Finder(subject, kLargerSize, *knob).find();
}

const Qualities& qualities_of(const Subject& subject) {
    std::optional<Qualities>& known = *subject.qualities;
    if (!known) known = find_qualities(subject);
    return *known;
}

std::string write_qualities(const Qualities& qualities) {
    Json::Value json;
    json["terrain_size"] = qualities.terrain_size;
    json["given"] = to_json(qualities.given);
    if (qualities.finest) json["finest"] = to_json(*qualities.finest);
    if (qualities.coarse) json["coarse"] = to_json(*qualities.coarse);
    return results::exact_text(json);
}

Qualities read_qualities(std::string_view line) {
    const Json::Value json = results::parse_json(line, "qualities found by a check");
    Qualities qualities;
    qualities.terrain_size = json["terrain_size"].asInt();
    qualities.given = from_json(json["given"]);
    if (json.isMember("finest")) qualities.finest = from_json(json["finest"]);
    if (json.isMember("coarse")) qualities.coarse = from_json(json["coarse"]);
    return qualities;
}

void check_each_quality(const Subject& subject, const std::function<void(const Selected&)>& check) {
    constexpr int kCameras = 2;
    const Qualities& qualities = qualities_of(subject);
    const TerrainPointer terrain = qualities.terrain();
    for (const Quality& quality : qualities.all()) {
        Session session(subject, terrain, quality.settings);
        Random random(subject.seed);
        for (int i = 0; i < kCameras; ++i) {
            const Camera camera = random_camera(random, session.terrain());
            session.select(camera, i);
            check({session, camera, i,
                   fmt::format("{}, camera {} of seed {}", quality.name, i, subject.seed)});
        }
    }
}

}  // namespace lodbench::conformance
