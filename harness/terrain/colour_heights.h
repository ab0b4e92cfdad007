#pragma once

namespace lodbench::terrain {

/// What to do about a raster of colours. Turned to grey it would still be read, and be no terrain.
inline constexpr const char* kColourHeights =
    "heights coded in colours, as terrain-RGB and terrarium tiles hold them, must be decoded "
    "first, "
    "with gdal_calc say: (R * 256 + G + B / 256) - 32768 for terrarium, (R * 65536 + G * 256 + B) "
    "/ 10 "
    "- 10000 for terrain-RGB; only a picture whose colours are all grey may be converted to grey";

}  // namespace lodbench::terrain
