#pragma once
// What the window shows and does: two methods in processes of their own, one camera, and the state
// that keys and widgets change.

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "results/frame.h"
#include "run/cell.h"
#include "run/plugin_library.h"
#include "scenario/camera_track.h"
#include "scenario/scenario.h"
#include "view/window.h"
#include "window/controls.h"
#include "window/messages.h"
#include "window/session.h"

namespace lodbench::view {

struct Setup {
    std::filesystem::path file;  ///< of the scenario
    scenario::Overrides overrides;
    scenario::Scenario scenario;
    std::shared_ptr<const Terrain> terrain;
    std::vector<run::MethodInfo> methods;  ///< at least one
    std::array<std::string, 2> shown;      ///< ids of the first and the second
    std::vector<run::Settings> settings;   ///< of each method, to begin with
    std::string device;
    std::filesystem::path program;  ///< that holds a method, see window::Session
    std::filesystem::path out;      ///< folder for screenshots and paths
    std::filesystem::path log;      ///< what happens, a JSON object a line; "" for none
    WindowOptions window;
};

/// One method on the screen.
struct Side {
    std::unique_ptr<window::Session> session;
    std::size_t method = 0;  ///< of Setup::methods
    run::Settings settings;
    std::optional<window::PictureRequest> asked;  ///< for the last picture, which may be under way
    bool opening = false, drawing = false, asynchronous = false;
    int repeats = 0;  ///< further pictures of the same view, while background work goes on
    double repeat_at = 0;
    std::optional<window::PictureReply> reply;
    std::vector<std::uint8_t> rgb;
    unsigned texture = 0;
    Viewport texture_size{0, 0};
    window::FrameTimes times;
    std::optional<results::FrameRecord> measured;
    bool measuring = false, measured_flown = false;
    std::optional<window::ProbeReply> probe;
    std::string words;  ///< why nothing is seen, or what fell
};

class Viewer {
public:
    explicit Viewer(Setup setup);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Until the window is closed.
    void run();

private:
    // viewer.cpp: what happens
    void update(double seconds);
    [[nodiscard]] double wait_seconds() const;
    void act(window::Action action);
    void act_on_method(window::Action action);
    void key(int key, bool control, bool pressed);
    void button(int button, bool pressed, const glm::dvec2& at);
    void moved(const glm::dvec2& at);
    void fly(double seconds);
    void open(Side& side);
    void choose(Side& side, std::size_t method);
    void turn_knob(Side& side, int way);
    void take_answers(Side& side);
    void take_answer(Side& side, const Json::Value& answer);
    void take_picture(Side& side, const Json::Value& answer);
    void ask_for_picture(Side& side);
    void ask_to_measure(Side& side);
    void probe(const glm::dvec2& at);
    void toggle_recording();
    void paste_camera();
    void take_over();
    void save_screenshot();
    void show_difference();
    void upload(unsigned& texture, Viewport& size, const std::vector<std::uint8_t>& rgb,
                const Viewport& of);
    void tell(const std::string& words);
    void log(Json::Value event);
    void log_state();

    [[nodiscard]] bool both() const { return layout_ != window::Layout::single; }
    [[nodiscard]] int sides() const { return both() ? 2 : 1; }
    [[nodiscard]] bool second_blinks() const;
    [[nodiscard]] Camera camera() const;    ///< that is flown, with the picture's size
    [[nodiscard]] Camera selected() const;  ///< that methods select for
    [[nodiscard]] Camera seen_from() const;
    [[nodiscard]] double sight() const;  ///< metres: how far a frustum is drawn
    [[nodiscard]] run::Settings effective(const Side& side) const;
    [[nodiscard]] const run::MethodInfo& method(const Side& side) const {
        return setup_.methods[side.method];
    }
    [[nodiscard]] std::filesystem::path new_file(const char* name, const char* extension) const;

    // panels.cpp: what is seen
    void draw();
    void draw_pictures();
    void draw_frustum();
    void draw_controls();
    void draw_params(Side& side);
    void draw_figures(const Side& side);
    void draw_graph(const Side& side);
    void draw_path();
    void draw_help();
    void note_item(const char* name);

    Setup setup_;
    scenario::CameraTrack track_;
    window::Playback playback_;
    window::FlyCamera fly_;
    window::PathRecorder recorder_;
    std::unique_ptr<Window> window_;
    std::array<Side, 2> sides_;
    unsigned difference_ = 0;
    Viewport difference_size_{0, 0};
    bool difference_due_ = false;
    std::set<window::Action> held_;
    window::FlyInput turn_;
    double unflown_ = 0;  ///< seconds that make no whole frame yet
    bool flying_ = false, frozen_ = false, culling_frozen_ = true, top_ = false, wireframe_ = false,
         overlay_ = true, help_ = false, screenshot_due_ = false, turning_ = false,
         splitting_ = false;
    window::Style style_ = window::Style::shaded;
    window::Layout layout_ = window::Layout::single;
    double split_ = 0.5, scale_px_ = 2;
    Camera frozen_camera_;
    glm::dvec2 cursor_{0.0};
    std::string message_;
    int redraw_ = 3;
    std::ofstream log_;
    Json::Value logged_;
    Json::Value items_;
};

}  // namespace lodbench::view
