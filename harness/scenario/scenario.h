#pragma once
// A scenario: what is flown, how, over what, and what is measured. Read from TOML.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/camera.h"
#include "api/method.h"
#include "scenario/flight_path.h"
#include "terrain/height_field.h"

namespace lodbench::scenario {

/// A method with its settings as written: text values, checked against the method's parameter specs
/// when its plugin is known. A parameter with several values is swept.
struct MethodRequest {
    std::string id;
    std::vector<std::pair<std::string, std::vector<std::string>>> settings;
    std::string where;  ///< "file.toml:31" or "--set lindstrom.tau=1"
};

struct MeasureOptions {
    int every = 10;            ///< measure every n-th frame of the lockstep replay; >= 1
    bool truth = true;         ///< measure what those frames really show: errors, cracks, popping
    bool pixels_only = false;  ///< of the truth what the pixels say, not what all samples do
    bool whole = false;        ///< height error over all of the terrain, in a replay of its own
    std::vector<int>
        shots;  ///< frames drawn to PNG (picture and wireframe); empty: first, middle, last
    std::vector<int> economy;  ///< frames compared with a near-minimal triangulation
    double budget_ms = 16.67;  ///< for the jank sum
};

/// What makes the frame times of a flight comparable: the value of each method's quality knob at
/// which it measures the same error, found by `match` and kept.
struct EqualError {
    struct Knob {
        std::string method, value;  ///< checked when the method's plugin is known
        std::string where;          ///< "file.toml:31"
        std::string off;            ///< why it shows another error: "" where it shows that of all
    };
    double error_px = 1;      ///< P99.9 of the pixel error
    double tolerance = 0.05;  ///< ratio, 1e-4 to 0.5
    std::vector<Knob> knobs;
};

struct Scenario {
    std::string name;  ///< [A-Za-z0-9_-]+, the file's stem unless given
    std::string text;  ///< the TOML as read, for the record
    terrain::TerrainSource terrain;
    Viewport viewport;
    double vertical_fov = 1.0471975511965976;  ///< radians
    double near_plane = 1.0;                   ///< metres
    int frames = 120;  ///< >= 1; of a recorded flight, unless it is written, all rows of its file
    int warmup_frames = 5;      ///< >= 0
    bool warmup_flies = false;  ///< the way to frame 0, with which the path begins
    double rate_hz = 60;        ///< simulated frames per second
    int repetitions = 3;        ///< >= 1
    std::uint64_t seed = 1;
    double cell_time_limit_s = 600;
    double frame_time_limit_s = 60;  ///< no sign of life for so long is a hang
    std::uint64_t memory_limit_bytes = 8ULL << 30;
    MeasureOptions measure;
    PathSpec path;
    std::optional<EqualError> equal;
    std::vector<MethodRequest> methods;  ///< empty: all methods that were found
};

/// Values that take the place of a scenario's own, by the path to their key: "flight.frames".
class Overrides {
public:
    struct Value {
        std::string toml;   ///< "25", "[0, 12]", "\"line\""
        std::string where;  ///< who asks for it, for messages: "--frames 25"
    };
    void set(const std::string& key, std::string toml, std::string where) {
        values_[key] = {std::move(toml), std::move(where)};
    }
    [[nodiscard]] bool has(const std::string& key) const { return values_.contains(key); }
    [[nodiscard]] bool empty() const { return values_.empty(); }
    [[nodiscard]] const std::map<std::string, Value>& values() const { return values_; }

private:
    std::map<std::string, Value> values_;
};

/// Parses a scenario. Relative files in it are relative to the scenario's folder. Caps file size (1
/// MiB), line length (4096 bytes) and nesting before the TOML parser sees the text. Throws
/// InputError as "FILE:LINE: what VALUE is wrong with; remedy"; an unknown key is an error that
/// lists the known ones.
/// `kept` is the copy of its recorded flight that a results folder keeps, or empty. Overrides are
/// put into the table that was read, and are checked as what the file says is; where they change
/// the number of frames, the frames that the file names move along.
[[nodiscard]] Scenario parse_scenario(std::string_view text, const std::filesystem::path& file,
                                      const std::filesystem::path& kept = {},
                                      const Overrides& overrides = {});

/// Where the copy of a recorded flight lies beside the scenario's file: NAME.flight.csv.
[[nodiscard]] std::filesystem::path place_of_kept_flight(const std::filesystem::path& file);
/// The same where there is one; else empty.
[[nodiscard]] std::filesystem::path kept_flight(const std::filesystem::path& file);

/// The same from a file, parsed in a child process first, so that a parser that dies costs a
/// message only. A recorded flight that is kept beside it goes before the file that it names: so a
/// scenario of a results folder is flown as it was.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file,
                                     const Overrides& overrides = {});

}  // namespace lodbench::scenario
