#pragma once
// A camera as a short text, to copy from one command or window and paste into another.
//
//     camera:X,Y,Z:HEADING,PITCH,ROLL:FOV:NEAR
//     camera:X,Y,Z:W,QX,QY,QZ:FOV:NEAR
//
// World metres; the orientation as angles in degrees (see scenario::Keyframe) or as a unit
// quaternion from the camera's frame to the world; the vertical field of view in degrees, or in
// radians with "rad" behind it; the near plane in metres. The viewport is not in it.

#include <string>
#include <string_view>

#include "api/camera.h"

namespace lodbench::scenario {

/// The text from which `parse_camera` makes the same camera to the bit, the viewport excepted.
/// Angles where they say the orientation to the bit, else the quaternion. The numbers are the
/// shortest decimals that read back as they were.
[[nodiscard]] std::string camera_string(const Camera& camera);

/// Throws InputError as "WHERE: what is wrong with it; remedy".
[[nodiscard]] Camera parse_camera(std::string_view text, const std::string& where);

}  // namespace lodbench::scenario
