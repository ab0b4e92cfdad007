#pragma once
// The four methods of this room, by what they differ in.

#include "api/method.h"

namespace lodbench::tile_quadtree {

[[nodiscard]] Method* create_dltq(const Params& params, CreateError* error) noexcept;
[[nodiscard]] Method* create_sltq_gpu(const Params& params, CreateError* error) noexcept;
[[nodiscard]] Method* create_sltq_cpu(const Params& params, CreateError* error) noexcept;
[[nodiscard]] Method* create_fu(const Params& params, CreateError* error) noexcept;

}  // namespace lodbench::tile_quadtree
