#pragma once
// A session over small hills, and waiting for its answers.

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "support/run_lodbench.h"
#include "terrain/open_terrain.h"
#include "window/messages.h"
#include "window/session.h"

namespace lodbench::test {

using window::PictureReply;
using window::PictureRequest;

inline const char* const kHills = R"(name = "hills"
[terrain]
synthetic = "ridged"
rows = 257
columns = 257
spacing = 30
[viewport]
width = 160
height = 120
[flight]
kind = "line"
frames = 4
warmup_frames = 2
start = [1000, 1000, 2500]
end = [4000, 4000, 2500]
pitch = -20
[measure]
every = 1
[run]
repetitions = 1
)";

class SessionFlight {
public:
    SessionFlight()
        : session_(std::string(LODBENCH_BUILD_DIR) + "/bin/lodbench-view", [this] { wake(); }) {
        std::ofstream(file()) << kHills;
    }
    [[nodiscard]] fs::path file() const { return scratch_.path() / "hills.toml"; }
    [[nodiscard]] const fs::path& folder() const { return scratch_.path(); }
    window::Session& session() { return session_; }

    run::CellSpec spec(const std::string& method, const fs::path& plugin,
                       const run::Settings& settings = {}) const {
        run::CellSpec spec;
        spec.scenario_file = spec.scenario_origin = file();
        spec.method = method;
        spec.plugin = plugin;
        spec.settings = settings;
        return spec;
    }
    run::CellSpec own(const std::string& method, const run::Settings& settings = {}) const {
        const std::string plugin = method == "hybrid-patches" ? "hybrid_patches"
                                   : method == "full-grid"    ? "full_grid"
                                   : method == "pgm"          ? "persistent_grid"
                                                              : method;
        return spec(method, fs::path(std::string(LODBENCH_PLUGINS) + "/" + plugin + ".so"),
                    settings);
    }

    /// The next answer to come.
    Json::Value answer() {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (answers_.empty()) {
            for (Json::Value& next : session_.take()) answers_.push_back(std::move(next));
            if (!answers_.empty()) break;
            std::unique_lock lock(mutex_);
            if (!woken_.wait_until(lock, deadline, [this] { return awake_; })) {
                throw std::runtime_error("no answer");
            }
            awake_ = false;
        }
        Json::Value first = answers_.front();
        answers_.pop_front();
        return first;
    }
    Json::Value open(const run::CellSpec& spec) {
        session_.open(spec);
        return answer();
    }
    PictureReply picture(const PictureRequest& request) {
        session_.ask(to_json(request));
        const Json::Value json = answer();
        EXPECT_FALSE(json.isMember("failed") || json.isMember("refused")) << json;
        return window::picture_reply(json);
    }
    std::vector<std::uint8_t> pixels(const PictureReply& reply) {
        const auto picture = session_.picture(reply.width, reply.height);
        return {picture.begin(), picture.end()};
    }

private:
    void wake() {
        const std::lock_guard lock(mutex_);
        awake_ = true;
        woken_.notify_all();
    }
    ScratchFolder scratch_;
    std::mutex mutex_;
    std::condition_variable woken_;
    bool awake_ = false;
    std::deque<Json::Value> answers_;
    window::Session session_;  // last: its reader wakes the others
};

inline Camera camera_of_frame(const fs::path& file, int frame) {
    const scenario::Scenario scenario = scenario::load_scenario(file);
    const auto terrain = terrain::open_terrain(scenario.terrain);
    return scenario::CameraTrack(scenario, *terrain).camera(frame);
}

inline PictureRequest request_of(const Camera& camera) {
    PictureRequest request;
    request.selected = request.view = camera;
    return request;
}

}  // namespace lodbench::test
