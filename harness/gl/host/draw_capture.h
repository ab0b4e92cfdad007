#pragma once
// What draw calls make, instead of a picture of it.

#include <functional>
#include <glm/vec4.hpp>
#include <span>

#include "gl/device.h"

namespace lodbench::gl {

/// Between begin and end every draw call of the device is fed back instead of rasterised and handed
/// to `sink`, in drawing order, one call of `sink` per draw call. Every draw call must be
/// idempotent: it is issued again when its triangles did not fit. The span is valid during the call
/// of `sink` only. Throws ContractError for a capture within a capture or a draw within someone's
/// GL_PRIMITIVES_GENERATED query, EnvironmentError when the driver has no memory for the triangles.
/// Never timed.
void begin_capture(Device& device, CaptureSink sink);
/// May be called after any exception; does nothing when no capture is open.
void end_capture(Device& device) noexcept;

}  // namespace lodbench::gl
