#pragma once
// What the program ends with; docs/manual.md says the same.

namespace lodbench::run {

enum ExitStatus : int {
    kAllWell = 0,
    kPromiseBroken = 1,    ///< a promise or a gate was not kept
    kWrongInput = 2,       ///< usage, scenario, terrain, plugin named by the user
    kCellFailed = 3,       ///< a method failed, crashed or hung
    kNothingMeasured = 4,  ///< no device, no room on the disk, nothing to fly
};

}  // namespace lodbench::run
