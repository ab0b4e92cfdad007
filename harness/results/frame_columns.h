#pragma once
// The columns of a frame: of frames/<cell>.csv, and of the array that a frame is on its way between
// processes.

#include <json/value.h>

#include <string>
#include <vector>

#include "results/cell.h"

namespace lodbench::results {

/// A frame as an array of numbers in the columns' order; what was not measured is null.
[[nodiscard]] Json::Value to_json(const FrameRecord& frame);
/// The reverse. Throws InputError as "WHERE: ..." for what is not such an array.
[[nodiscard]] FrameRecord read_frame(const Json::Value& row, const std::string& where);

/// frames/<cell>.csv: a header and a line for each frame; what was not measured is an empty field,
/// an infinite error the text inf.
[[nodiscard]] std::string frames_csv(const std::vector<FrameRecord>& frames);

}  // namespace lodbench::results
