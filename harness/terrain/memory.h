#pragma once
// What fits into memory is asked before it is taken.

#include <cstdint>
#include <optional>
#include <string>

namespace lodbench::terrain {

/// Bytes, the kernel's estimate of what can be allocated; nothing where it does not say.
[[nodiscard]] std::optional<std::int64_t> available_memory();

/// Throws InputError, "WHAT: ...", for a grid that is too small (under 2 x 2) or of more samples
/// than are read, 2^36.
void check_grid_size(const std::string& what, std::int64_t rows, std::int64_t columns);

/// The same for a grid that is to be held as float32, at most 2^31 samples and no more than the
/// memory that is free. `remedy` ends the message.
void check_field_size(const std::string& what, std::int64_t rows, std::int64_t columns,
                      const std::string& remedy = "crop or thin it, or make it a store (.tiles)");

}  // namespace lodbench::terrain
