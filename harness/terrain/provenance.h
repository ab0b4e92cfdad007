#pragma once
// Where a terrain's heights come from, and what is doubtful about them.

#include <string>
#include <vector>

namespace lodbench::terrain {

struct Provenance {
    std::string kind = {};         ///< "png, uint16, through OpenImageIO"; "synthetic"
    bool spacing_assumed = false;  ///< neither source, sidecar nor file says it: 1 m was taken
    /// The file's reference system and what was done with its coordinates, in words; empty where
    /// the file has none by nature (images, raw heights, stores, synthetic terrains).
    std::string reference = {};
    /// What was read and may not be what was meant, each in one line that begins with the file.
    std::vector<std::string> warnings = {};
};

}  // namespace lodbench::terrain
