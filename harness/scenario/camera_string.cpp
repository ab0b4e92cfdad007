#include "scenario/camera_string.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <vector>

#include "api/error.h"
#include "base/printable.h"
#include "scenario/flight_path.h"

namespace lodbench::scenario {
namespace {

constexpr std::string_view kPrefix = "camera:";
constexpr double kFarthest = 1e9;        // metres, as for a recorded flight
constexpr double kUnitTolerance = 1e-6;  // of a quaternion's length that a person has shortened

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = std::min(text.find(separator), text.size());
        parts.push_back(text.substr(0, end));
        if (end == text.size()) return parts;
        text.remove_prefix(end + 1);
    }
}

std::string joined(std::initializer_list<double> numbers) {
    std::string text;
    for (const double number : numbers) {
        text += fmt::format("{}{}", text.empty() ? "" : ",", number + 0.0);
    }
    return text;
}

bool equal(const glm::dquat& a, const glm::dquat& b) {
    return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z;
}

std::string orientation_text(const glm::dquat& q) {
    const glm::dvec3 angles = angles_of(q);
    if (equal(orientation_of(angles.x, angles.y, angles.z), q)) {
        return joined({angles.x, angles.y, angles.z});
    }
    return joined({q.w, q.x, q.y, q.z});
}

std::string fov_text(double radians) {
    const double degrees = rounded_angle(glm::degrees(radians));
    return glm::radians(degrees) == radians ? fmt::format("{}", degrees)
                                            : fmt::format("{}rad", radians);
}

class CameraText {
public:
    explicit CameraText(const std::string& where, std::string_view text)
        : where_(where), text_(text) {}

    Camera parse() const {
        if (!text_.starts_with(kPrefix)) refuse("it does not begin with 'camera:'");
        const auto parts = split(text_.substr(kPrefix.size()), ':');
        if (parts.size() != 4) refuse(fmt::format("it has {} parts after 'camera:'", parts.size()));
        Camera camera;
        const std::vector<double> place = numbers(parts[0], kFarthest);
        if (place.size() != 3) refuse("its position has not three numbers");
        camera.position = {place[0], place[1], place[2]};
        camera.orientation = orientation(numbers(parts[1], 360));
        camera.vertical_fov = field_of_view(parts[2]);
        const std::vector<double> near = numbers(parts[3], 1e6);
        if (near.size() != 1 || near[0] < 1e-3) refuse("its near plane is not 0.001 to 1e6 metres");
        camera.near_plane = near[0];
        return camera;
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(
            fmt::format("{}: {} is no camera: {}; copy one from `lodbench view`, or write "
                        "camera:X,Y,Z:HEADING,PITCH,ROLL:FOV:NEAR (metres and degrees)",
                        where_, base::printable(text_), what));
    }

    [[nodiscard]] std::vector<double> numbers(std::string_view part, double most) const {
        std::vector<double> values;
        for (const std::string_view field : split(part, ',')) {
            double value = 0;
            const char* const last = field.data() + field.size();
            const auto [end, error] = std::from_chars(field.data(), last, value);
            if (error != std::errc() || end != last || !std::isfinite(value) ||
                std::abs(value) > most) {
                refuse(fmt::format("{} is not a number from {} to {}", base::printable(field),
                                   -most, most));
            }
            values.push_back(value);
        }
        return values;
    }

    [[nodiscard]] glm::dquat orientation(const std::vector<double>& values) const {
        if (values.size() == 3) return orientation_of(values[0], values[1], values[2]);
        if (values.size() != 4) refuse("its orientation has neither three angles nor four numbers");
        const glm::dquat q(values[0], values[1], values[2], values[3]);
        if (!(std::abs(glm::length(q) - 1) <= kUnitTolerance)) {
            refuse("its quaternion is not of unit length");
        }
        return q;
    }

    [[nodiscard]] double field_of_view(std::string_view part) const {
        constexpr std::string_view kRadians = "rad";
        const bool radians = part.ends_with(kRadians);
        if (radians) part.remove_suffix(kRadians.size());
        const std::vector<double> values = numbers(part, 180);
        const double value = radians ? values[0] : glm::radians(values[0]);
        if (values.size() != 1 || value < glm::radians(1.0) || value > glm::radians(170.0)) {
            refuse("its field of view is not 1 to 170 degrees");
        }
        return value;
    }

    const std::string& where_;
    std::string_view text_;
};

}  // namespace

std::string camera_string(const Camera& camera) {
    const glm::dvec3& p = camera.position;
    return fmt::format("{}{}:{}:{}:{}", kPrefix, joined({p.x, p.y, p.z}),
                       orientation_text(camera.orientation), fov_text(camera.vertical_fov),
                       camera.near_plane);
}

Camera parse_camera(std::string_view text, const std::string& where) {
    return CameraText(where, text).parse();
}

}  // namespace lodbench::scenario
