#pragma once
// How a person moves in the window: flying, replaying a path, recording one, splitting the picture.
// No window system here.

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/camera.h"
#include "scenario/recorded_path.h"

namespace lodbench::window {

/// The keys that are held, each -1, 0 or 1, and by how many degrees the mouse turned.
struct FlyInput {
    int ahead = 0, right = 0, up = 0;
    double turn_right = 0, turn_up = 0;
    [[nodiscard]] bool moves() const {
        return ahead != 0 || right != 0 || up != 0 || turn_right != 0 || turn_up != 0;
    }
};

/// A camera that a person flies. Positions are rounded to millimetres and angles to 1e-4 degrees,
/// so that what is shown, recorded and copied is the same to the bit, and short to write.
class FlyCamera {
public:
    static constexpr double kSlowest = 1, kFastest = 1e5;  ///< m/s

    /// Ground height in metres at a place.
    using Ground = std::function<double(const glm::dvec2&)>;

    /// Takes over where `camera` stands; its roll and lens stay.
    void take_over(const Camera& camera);
    /// Moves for `seconds`. Following, the height above ground stays but for `input.up`.
    void step(const FlyInput& input, double seconds, const Ground& ground);
    /// Faster by so many notches of a wheel (a quarter each), within kSlowest and kFastest.
    void change_speed(double notches);
    /// At least a metre above ground.
    void follow_ground(bool follow, const Ground& ground);

    [[nodiscard]] bool follows_ground() const { return above_ground_.has_value(); }
    [[nodiscard]] double speed() const { return speed_; }
    [[nodiscard]] Camera camera() const;
    [[nodiscard]] const scenario::RecordedPlace& place() const { return place_; }

private:
    void settle(const Ground& ground);

    Camera lens_;
    scenario::RecordedPlace place_;
    double speed_ = 500;
    std::optional<double> above_ground_;
};

/// The replay of a path of `frames` frames at a simulated rate.
class Playback {
public:
    Playback(int frames, double rate_hz) : frames_(frames), rate_hz_(rate_hz) {}

    [[nodiscard]] int frame() const { return int(position_); }
    [[nodiscard]] int frames() const { return frames_; }
    [[nodiscard]] bool playing() const { return playing_; }
    /// From the beginning again where it stands at the end.
    void play(bool on);
    /// Stops, and moves by so many frames.
    void step(int frames);
    /// To a frame, within the path.
    void seek(int frame);
    /// Moves on while it plays; stops at the last frame. True where the frame changed.
    bool advance(double seconds);

private:
    int frames_;
    double rate_hz_;
    double position_ = 0;
    bool playing_ = false;
};

/// A path that is being recorded, a place for each frame of the simulated rate.
class PathRecorder {
public:
    [[nodiscard]] bool recording() const { return recording_; }
    void start();
    void add(const scenario::RecordedPlace& place);
    /// Ends it and gives the CSV that `run --flight` flies; "" where nothing was recorded.
    [[nodiscard]] std::string stop();
    [[nodiscard]] std::size_t frames() const { return places_.size(); }

private:
    std::vector<scenario::RecordedPlace> places_;
    bool recording_ = false;
};

/// How two methods are shown.
enum class Layout { single, side_by_side, split, difference, blink };
[[nodiscard]] const char* name_of(Layout layout);
[[nodiscard]] Layout next(Layout layout);

/// A rectangle of the window, pixels from its top left corner, and the part of a picture that
/// fills it, 0 to 1 from the left.
struct Pane {
    int method = 0;  ///< 0 the first, 1 the second
    double x = 0, width = 0;
    double from = 0, to = 1;
};
/// What stands where: side by side each method has a half, split both fill the window and the
/// first is seen left of `split` (0 to 1). `second` of a blink is shown in each other half second.
[[nodiscard]] std::vector<Pane> panes(Layout layout, double width, double split, bool second);
/// The picture's size for a window of that size: half of it side by side.
[[nodiscard]] Viewport picture_size(Layout layout, const Viewport& window);
/// Where in the picture of which method a position of the window (fractions of it) is.
struct PicturePlace {
    int method = 0;
    glm::dvec2 at{0.0};  ///< fractions of the picture
};
[[nodiscard]] PicturePlace picture_place(Layout layout, double split, bool second,
                                         const glm::dvec2& at);

/// |first - second| of two pictures of one size, eight times as bright; RGB.
[[nodiscard]] std::vector<std::uint8_t> difference(const std::vector<std::uint8_t>& first,
                                                   const std::vector<std::uint8_t>& second);

/// What a key does.
enum class Action {
    ahead,
    back,
    left,
    right,
    up,
    down,  // held
    follow,
    play,
    previous_frame,
    next_frame,
    first_frame,
    record,
    copy_camera,
    paste_camera,
    next_method,
    previous_method,
    finer,
    coarser,
    wireframe,
    style,
    layout,
    freeze,
    freeze_culling,
    top_view,
    measure,
    screenshot,
    end_method,
    overlay,
    help,
    quit
};
struct KeyBinding {
    Action action;
    int key;           ///< GLFW's number
    bool control;      ///< with Ctrl held
    const char* name;  ///< "W", "Ctrl+C"
    const char* does;
};
/// All of them, in the order in which help lists them.
[[nodiscard]] const std::vector<KeyBinding>& key_bindings();
[[nodiscard]] std::optional<Action> action_of(int key, bool control);

/// Times of the last frames for the graph.
class FrameTimes {
public:
    static constexpr std::size_t kKept = 240;
    void add(double ms);
    void clear() { ms_.clear(); }
    [[nodiscard]] const std::vector<float>& ms() const { return ms_; }  ///< oldest first
    /// Nearest rank, p in (0, 1]; nothing when empty.
    [[nodiscard]] std::optional<double> percentile(double p) const;

private:
    std::vector<float> ms_;
};

/// Line segments of a camera's frustum to `depth` metres, in the world: four edges and the frame at
/// their ends.
[[nodiscard]] std::vector<std::pair<glm::dvec3, glm::dvec3>> frustum_lines(const Camera& camera,
                                                                           double depth);

/// A camera that looks straight down on the terrain around `camera` with north upward, so that what
/// `camera` sees up to `depth` metres lies in its picture.
[[nodiscard]] Camera top_camera(const Camera& camera, double depth);

}  // namespace lodbench::window
