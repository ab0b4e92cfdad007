#pragma once
// The methods of this room.

#include "api/method.h"

namespace lodbench::stitching_strips {

[[nodiscard]] Method* create_dss(const Params& params, CreateError* error) noexcept;
[[nodiscard]] Method* create_tess_pow2(const Params& params, CreateError* error) noexcept;
[[nodiscard]] Method* create_tess_uniform(const Params& params, CreateError* error) noexcept;

}  // namespace lodbench::stitching_strips
