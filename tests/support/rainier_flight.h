#pragma once
// A flight on which claimed bounds are put to the test.

#include <fmt/format.h>

#include "support/run_lodbench.h"

namespace lodbench::test {

/// Up to Mount Rainier, three frames measured, with another field of view.
inline fs::path rainier_flight(const fs::path& folder, int fov) {
    const std::string name = "fov" + std::to_string(fov);
    const fs::path file = folder / (name + ".toml");
    std::ofstream(file) << fmt::format(R"(name = "{}"
[terrain]
file = "{}/scenarios/terrain/puget_sound_1025_160m.png"
spacing = 160
vertical_scale = 0.1
[camera]
vertical_fov = {}
near = 10
[viewport]
width = 320
height = 240
[flight]
kind = "line"
start = [98000, 82500, 1600]
end = [116500, 78000, 3200]
pitch = -9
frames = 9
warmup_frames = 0
[measure]
every = 4
shots = [0]
[run]
repetitions = 1
)",
                                       name, LODBENCH_SOURCE_DIR, fov);
    return file;
}

}  // namespace lodbench::test
