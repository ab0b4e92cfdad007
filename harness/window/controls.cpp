#include "window/controls.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "api/error.h"
#include "scenario/flight_path.h"

namespace lodbench::window {
namespace {

constexpr double kSteepest = 89;         // degrees: beyond it heading means nothing
constexpr double kLeastAboveGround = 1;  // metres
constexpr double kFaster = 1.25;         // a notch of the wheel

double in_millimetres(double metres) {
    return std::round(metres * 1e3) / 1e3;
}

}  // namespace

void FlyCamera::take_over(const Camera& camera) {
    lens_ = camera;
    place_.angles = scenario::angles_of(camera.orientation);
    place_.position = camera.position;
    settle({});
}

void FlyCamera::settle(const Ground& ground) {
    glm::dvec3& p = place_.position;
    glm::dvec3& a = place_.angles;
    if (above_ground_ && ground) p.z = ground(glm::dvec2(p)) + *above_ground_;
    p = {in_millimetres(p.x), in_millimetres(p.y), in_millimetres(p.z)};
    a.x = scenario::rounded_angle(a.x - 360 * std::floor(a.x / 360));
    a.y = scenario::rounded_angle(std::clamp(a.y, -kSteepest, kSteepest));
    a.z = scenario::rounded_angle(a.z);
}

void FlyCamera::step(const FlyInput& input, double seconds, const Ground& ground) {
    place_.angles.x += input.turn_right;
    place_.angles.y += input.turn_up;
    settle({});
    const Camera now = camera();
    const double way = speed_ * seconds;
    glm::dvec3 ahead = now.forward();
    if (above_ground_) {
        const glm::dvec2 level = glm::dvec2(ahead);
        ahead = glm::dvec3(level / std::max(glm::length(level), 1e-9), 0);
        above_ground_ = std::max(*above_ground_ + input.up * way, kLeastAboveGround);
    } else {
        place_.position.z += input.up * way;
    }
    place_.position += way * (double(input.ahead) * ahead + double(input.right) * now.right());
    settle(ground);
}

void FlyCamera::change_speed(double notches) {
    speed_ = std::clamp(speed_ * std::pow(kFaster, notches), kSlowest, kFastest);
}

void FlyCamera::follow_ground(bool follow, const Ground& ground) {
    above_ground_.reset();
    if (!follow) return;
    above_ground_ =
        std::max(place_.position.z - ground(glm::dvec2(place_.position)), kLeastAboveGround);
    settle(ground);
}

Camera FlyCamera::camera() const {
    Camera camera = lens_;
    camera.position = place_.position;
    camera.orientation =
        scenario::orientation_of(place_.angles.x, place_.angles.y, place_.angles.z);
    return camera;
}

void Playback::play(bool on) {
    if (on && frame() + 1 >= frames_) position_ = 0;
    playing_ = on;
}

void Playback::step(int frames) {
    playing_ = false;
    seek(frame() + frames);
}

void Playback::seek(int frame) {
    position_ = std::clamp(frame, 0, frames_ - 1);
}

bool Playback::advance(double seconds) {
    if (!playing_) return false;
    const int before = frame();
    position_ += seconds * rate_hz_;
    if (position_ >= frames_ - 1) {
        position_ = frames_ - 1;
        playing_ = false;
    }
    return frame() != before;
}

void PathRecorder::start() {
    places_.clear();
    recording_ = true;
}

void PathRecorder::add(const scenario::RecordedPlace& place) {
    if (recording_) places_.push_back(place);
}

std::string PathRecorder::stop() {
    recording_ = false;
    return places_.empty() ? std::string() : scenario::recorded_csv(places_);
}

const char* name_of(Layout layout) {
    constexpr const char* kNames[] = {"single", "side by side", "split", "difference", "blink"};
    return kNames[std::size_t(layout)];
}

Layout next(Layout layout) {
    return layout == Layout::blink ? Layout::single : Layout(int(layout) + 1);
}

std::vector<Pane> panes(Layout layout, double width, double split, bool second) {
    switch (layout) {
        case Layout::single: return {{0, 0, width}};
        case Layout::side_by_side: return {{0, 0, width / 2}, {1, width / 2, width / 2}};
        case Layout::split:
            return {{0, 0, width * split, 0, split},
                    {1, width * split, width * (1 - split), split, 1}};
        case Layout::difference: return {{0, 0, width}};
        case Layout::blink: return {{second ? 1 : 0, 0, width}};
    }
    throw ContractError("panes: the layout is not one of Layout");
}

Viewport picture_size(Layout layout, const Viewport& window) {
    const int width = layout == Layout::side_by_side ? window.width / 2 : window.width;
    return {std::max(width, 1), std::max(window.height, 1)};
}

PicturePlace picture_place(Layout layout, double split, bool second, const glm::dvec2& at) {
    for (const Pane& pane : panes(layout, 1, split, second)) {
        if (pane.width <= 0 || at.x < pane.x || at.x > pane.x + pane.width) continue;
        const double across = (at.x - pane.x) / pane.width;
        return {pane.method, {pane.from + across * (pane.to - pane.from), at.y}};
    }
    return {0, at};
}

std::vector<std::uint8_t> difference(const std::vector<std::uint8_t>& first,
                                     const std::vector<std::uint8_t>& second) {
    constexpr int kBrighter = 8;
    if (first.size() != second.size()) {
        throw ContractError("difference: the pictures are not of one size");
    }
    std::vector<std::uint8_t> result(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        const int apart = std::abs(int(first[i]) - int(second[i]));
        result[i] = std::uint8_t(std::min(kBrighter * apart, 255));
    }
    return result;
}

const std::vector<KeyBinding>& key_bindings() {
    using enum Action;
    // GLFW's numbers: letters and punctuation are their capital ASCII codes.
    constexpr int kSpace = 32, kEscape = 256, kRight = 262, kLeft = 263, kHome = 268, kF1 = 290,
                  kF12 = 301;
    static const std::vector<KeyBinding> bindings = {
        {ahead, 'W', false, "W", "fly ahead (drag with the left button to turn, wheel for speed)"},
        {back, 'S', false, "S", "fly back"},
        {left, 'A', false, "A", "fly to the left"},
        {right, 'D', false, "D", "fly to the right"},
        {up, 'E', false, "E", "rise"},
        {down, 'Q', false, "Q", "sink"},
        {follow, 'G', false, "G", "follow the ground, or not"},
        {play, kSpace, false, "Space", "play the scenario's flight, or pause"},
        {previous_frame, kLeft, false, "Left", "a frame back"},
        {next_frame, kRight, false, "Right", "a frame on"},
        {first_frame, kHome, false, "Home", "to the first frame"},
        {record, 'R', false, "R", "record a path, or write it (CSV, for run --flight)"},
        {copy_camera, 'C', true, "Ctrl+C", "copy the camera (for --camera)"},
        {paste_camera, 'V', true, "Ctrl+V", "paste a camera"},
        {next_method, 'M', false, "M", "the next method"},
        {previous_method, 'N', false, "N", "the method before"},
        {finer, '[', false, "[", "quality knob down"},
        {coarser, ']', false, "]", "quality knob up"},
        {wireframe, 'F', false, "F", "wireframe"},
        {style, 'H', false, "H", "shaded, error heat map, cracks, colours by level"},
        {layout, 'L', false, "L", "one method, side by side, split, difference, blink"},
        {freeze, 'Z', false, "Z", "freeze the selection, and look at it from elsewhere"},
        {freeze_culling, 'X', false, "X", "whether what was out of view stays left out"},
        {top_view, 'T', false, "T", "look from above"},
        {measure, 'I', false, "I", "measure this frame as the harness does"},
        {screenshot, kF12, false, "F12", "screenshot (PNG)"},
        {end_method, 'K', false, "K", "end a method that hangs"},
        {overlay, 'O', false, "O", "show or hide the figures"},
        {help, kF1, false, "F1", "this help"},
        {quit, kEscape, false, "Esc", "quit"}};
    return bindings;
}

std::optional<Action> action_of(int key, bool control) {
    for (const KeyBinding& binding : key_bindings()) {
        if (binding.key == key && binding.control == control) return binding.action;
    }
    return std::nullopt;
}

void FrameTimes::add(double ms) {
    if (ms_.size() == kKept) ms_.erase(ms_.begin());
    ms_.push_back(float(ms));
}

std::optional<double> FrameTimes::percentile(double p) const {
    if (ms_.empty()) return std::nullopt;
    std::vector<float> sorted = ms_;
    std::ranges::sort(sorted);
    const double rank = std::ceil(p * double(sorted.size()));
    return double(sorted[std::size_t(std::clamp(rank, 1.0, double(sorted.size()))) - 1]);
}

std::vector<std::pair<glm::dvec3, glm::dvec3>> frustum_lines(const Camera& camera, double depth) {
    const glm::dvec2 t = camera.half_tangents() * depth;
    const glm::dvec3 middle = camera.position + depth * camera.forward();
    const glm::dvec3 right = t.x * camera.right(), up = t.y * camera.up();
    const glm::dvec3 corners[] = {middle - right - up, middle + right - up, middle + right + up,
                                  middle - right + up};
    std::vector<std::pair<glm::dvec3, glm::dvec3>> lines;
    for (int i = 0; i < 4; ++i) {
        lines.emplace_back(camera.position, corners[i]);
        lines.emplace_back(corners[i], corners[(i + 1) % 4]);
    }
    return lines;
}

Camera top_camera(const Camera& camera, double depth) {
    Camera top = camera;
    const glm::dvec3 level(camera.forward().x, camera.forward().y, 0);
    const double across = 1.2 * depth;  // what the picture shows from its middle to its edge
    const glm::dvec2 tangents = camera.half_tangents();
    top.position = camera.position + level * (depth / 2);
    top.position.z += across / std::min(tangents.x, tangents.y);
    top.orientation = Camera::look({0, 0, -1}, {0, 1, 0});
    return top;
}

}  // namespace lodbench::window
