#pragma once
// `<file>.toml` beside a raster: what the raster cannot say of itself.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace lodbench::terrain {

enum class SampleType { int16, uint16, float32 };

/// Every key is optional but where the reader of the raster needs it.
struct Sidecar {
    std::filesystem::path file;  ///< empty: there is no sidecar
    std::optional<std::string> name;
    std::optional<double> spacing_x, spacing_y;  ///< `spacing = 160` or `spacing = [x, y]`, metres
    std::optional<double> vertical_scale;        ///< metres per unit of the file
    std::optional<double> vertical_offset;       ///< metres, added after scaling
    std::optional<double> no_data;               ///< in units of the file; may be nan or inf
    std::optional<double> origin_x,
        origin_y;  ///< `origin = [x, y]`, metres, of the south-west sample
    std::optional<std::uint64_t>
        voids_filled;  ///< samples that were filled before the file was written

    // Raw files only.
    std::optional<int> rows;
    std::optional<int> columns;
    std::optional<SampleType> type;  ///< "int16", "uint16", "float32"
    std::optional<bool> big_endian;  ///< `endian = "little"` or "big"
};

/// Where the sidecar of a raster lies: the raster's path with ".toml" appended.
[[nodiscard]] std::filesystem::path sidecar_path(const std::filesystem::path& raster);

/// Reads the sidecar of `raster`; without one, an empty Sidecar. Throws InputError ("FILE:LINE:
/// ...") for an unknown key (listing the known ones), a wrong type or a value out of range.
[[nodiscard]] Sidecar read_sidecar(const std::filesystem::path& raster);

/// The TOML of a sidecar; numbers read back to the bit.
[[nodiscard]] std::string sidecar_text(const Sidecar& sidecar);

}  // namespace lodbench::terrain
