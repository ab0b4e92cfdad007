#pragma once
// One method at one step, in a process of its own: flown in lockstep, captured, measured, and
// compared with the world as it is where the step moves or scales it.

#include <filesystem>
#include <string>

#include "extremes/battery.h"
#include "results/extremes.h"
#include "run/plugin_library.h"
#include "run/settings.h"

namespace lodbench::extremes {

/// What is flown.
struct Probe {
    std::filesystem::path scenario;  ///< the mild setting
    scenario::Overrides overrides;   ///< of it
    WorldChange world;
    run::MethodInfo method;
    run::Settings settings;
    std::string device;             ///< as for platform::Context
    std::filesystem::path picture;  ///< of the worst frame; "": none
};

/// How it ended, as far as it came.
struct ProbeOutcome {
    enum class Ending { finished, failed, skipped, crashed, hung, out_of_memory };
    Ending ending = Ending::finished;
    std::string words;  ///< of what did not finish: what happened and where
    results::ExtremesFigures figures;
    std::string terrain, terrain_checksum, device;
};

/// Flies it in a child process with the scenario's limits of time and memory. Throws InputError for
/// what the scenario or its terrain has wrong, EnvironmentError where there is no device,
/// run::Interrupted.
[[nodiscard]] ProbeOutcome fly(const Probe& probe);

}  // namespace lodbench::extremes
