#include "run/vital_signs.h"

#include <array>

namespace lodbench::run {

const char* name_of(Call call) {
    static constexpr std::array<const char*, std::size_t(Call::count_)> kNames = {
        "none",
        "start",
        "load_terrain",
        "open_plugin",
        "create",
        "prepare",
        "upload",
        "resize",
        "select",
        "draw",
        "settle",
        "pause_background",
        "resume_background",
        "counters",
        "release",
        "destroy",
        "write_results"};
    // The page is shared with a process that may have scribbled over it.
    return call < Call::count_ ? kNames[std::size_t(call)] : "an unknown call";
}

const char* name_of(Replay replay) {
    constexpr std::array kNames = {"no", "timing", "lockstep", "real-time", "whole-terrain"};
    return kNames.at(std::size_t(replay));
}

}  // namespace lodbench::run
