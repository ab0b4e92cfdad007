#pragma once
// The two methods of this room.

#include "api/method.h"

namespace lodbench::hybrid_patches {

[[nodiscard]] Method* create_static_patches(const Params& params, CreateError* error) noexcept;
[[nodiscard]] Method* create_hybrid_patches(const Params& params, CreateError* error) noexcept;

}  // namespace lodbench::hybrid_patches
