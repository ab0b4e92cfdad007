#pragma once
// Flights recorded elsewhere: one row of CSV a frame.

#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodbench::scenario {

/// World metres; heading, pitch, roll in degrees.
struct RecordedPlace {
    glm::dvec3 position{0.0};
    glm::dvec3 angles{0.0};
};

/// Parses "frame,x,y,z,heading,pitch,roll": that header line, then one row of seven finite numbers
/// for each frame 0, 1, 2, ... As spreadsheets write it, too: a UTF-8 byte order mark; lines that
/// end with LF, CRLF or CR; fields between semicolons or tabs, as the header has them, then with
/// decimal points or decimal commas, not both in one file; fields in quotes; blanks around fields;
/// empty lines at the end. There are no comments. Throws InputError as "FILE:LINE: what VALUE is
/// wrong with; remedy".
[[nodiscard]] std::vector<RecordedPlace> parse_recorded(std::string_view text,
                                                        const std::filesystem::path& file);

/// What `parse_recorded` reads as the same places to the bit. Throws InputError for a place with a
/// number beyond 1e9 or not finite.
[[nodiscard]] std::string recorded_csv(std::span<const RecordedPlace> places);

/// The same from a file of at most 256 MiB.
[[nodiscard]] std::vector<RecordedPlace> load_recorded(const std::filesystem::path& file);

}  // namespace lodbench::scenario
