#pragma once
// What GDAL does not check of an Arc ASCII grid (.asc). It takes a word for 0 and an indented
// header line for cells, and cannot read integers with a nan among them.

#include <cstdint>
#include <filesystem>

namespace lodbench::terrain {

struct AsciiGrid {
    bool recognised = false;  ///< false: the file does not begin like a grid; GDAL says what it is
    std::int64_t rows = 0;
    std::int64_t columns = 0;
    bool fractional = false;  ///< a cell is no integer of 32 bits
};

/// Reads the whole text: header lines of a known key and a number from the first column on, then as
/// many numbers as rows * columns, apart by white space. Throws InputError, "FILE: what, where,
/// value; remedy", for a byte order mark, a header line that is indented, unknown, given twice or
/// without its number, a header without size or spacing, a cell that is no number, and too few or
/// too many cells.
[[nodiscard]] AsciiGrid check_ascii_grid(const std::filesystem::path& file);

}  // namespace lodbench::terrain
