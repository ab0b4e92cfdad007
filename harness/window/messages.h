#pragma once
// What the window asks of the process that holds a method, and what that answers: JSON, a message a
// packet, in both directions. Pictures go through memory that both map.

#include <json/value.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/camera.h"

namespace lodbench::window {

/// What a picture shows.
enum class Style { shaded, errors, cracks, levels };
[[nodiscard]] const char* name_of(Style style);
[[nodiscard]] Style next(Style style);

/// A picture of what the method selects for `selected`, seen from `view`. Both cameras have the
/// picture's size.
struct PictureRequest {
    Camera selected, view;
    std::int64_t frame = 0;  ///< for the method's clock
    bool frozen = false;     ///< no new selection while `selected` stays the same
    bool wireframe = false;
    Style style = Style::shaded;
    double scale_px = 1;  ///< top of the heat map
    friend bool operator==(const PictureRequest& a, const PictureRequest& b);
};

/// What stands beside a picture. Times in milliseconds.
struct PictureReply {
    int width = 0, height = 0;
    double select_ms = 0, submit_ms = 0, wall_ms = 0;
    std::optional<double> gpu_ms;  ///< software: from the end of selection to the end of the work
    std::uint64_t triangles = 0, draw_calls = 0, uploaded_bytes = 0, gpu_bytes = 0;
    // Where the style is errors or cracks.
    std::optional<double> pixel_max_px, pixel_p999_px, pixel_rms_px;
    std::optional<std::uint64_t> crack_pixels;
};

/// What lies below a pixel of the last picture.
struct ProbeReply {
    bool hit = false;
    int row = 0, column = 0;             ///< nearest sample
    double x = 0, y = 0;                 ///< world, metres
    double true_low = 0, true_high = 0;  ///< metres, spanned by the cell's diagonals
    std::optional<double> drawn;         ///< metres; nothing where no triangle covers it
    std::optional<double> error_px;      ///< distance on screen of the drawn and the true point
    std::optional<double> error_m;       ///< drawn minus true
    std::optional<int> level;            ///< by the size of the triangle, see level_of
};

/// log2 of the longest edge of a triangle in plan over the diagonal of a grid cell, rounded and at
/// least 0: the level of detail as far as sizes tell it.
[[nodiscard]] int level_of(double longest_edge, double cell_diagonal);

[[nodiscard]] Json::Value to_json(const PictureRequest& request);
[[nodiscard]] PictureRequest picture_request(const Json::Value& json);
[[nodiscard]] Json::Value to_json(const PictureReply& reply);
[[nodiscard]] PictureReply picture_reply(const Json::Value& json);
[[nodiscard]] Json::Value to_json(const ProbeReply& reply);
[[nodiscard]] ProbeReply probe_reply(const Json::Value& json);

/// The largest picture that shared memory has room for.
inline constexpr int kLargestSide = 8192;
inline constexpr std::size_t kPictureBytes = std::size_t(kLargestSide) * kLargestSide * 3;

/// Sends one packet; false where the other side is gone.
bool send_message(int socket, const Json::Value& message);
/// Waits for one; nothing where the other side is gone. Throws InputError for what is no message.
[[nodiscard]] std::optional<Json::Value> receive_message(int socket);

}  // namespace lodbench::window
