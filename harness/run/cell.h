#pragma once
// One cell of a campaign: method x scenario x setting x repetition, and flying it.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "results/cell.h"
#include "run/settings.h"
#include "run/vital_signs.h"
#include "scenario/scenario.h"

namespace lodbench::run {

/// All that a child process needs to know.
struct CellSpec {
    std::string id;  ///< file-name safe, unique in the campaign: "lindstrom__tau=1__demo__r0"
    std::filesystem::path scenario_file;    ///< copy in the results folder
    std::filesystem::path scenario_origin;  ///< what was copied: named in messages, and what the
                                            ///< scenario's relative files are relative to
    scenario::Overrides overrides;
    std::string method;
    std::filesystem::path plugin;
    Settings settings;
    int repetition = 0;
    std::uint64_t seed = 1;
    std::string device;              ///< as for platform::Context
    std::filesystem::path out;       ///< results folder
    std::filesystem::path views;     ///< folder of the ViewCache; "": there is none
    bool wait_for_debugger = false;  ///< with the plugin opened, before its first call
};

/// What the child process is given. Throws InputError (reading) for what is damaged.
[[nodiscard]] std::string write_spec(const CellSpec& spec);
[[nodiscard]] CellSpec read_spec(std::string_view text, const std::string& where);

/// Flies one cell in this process: load, prepare, timing replay, lockstep replay with the truth and
/// the pictures, and for asynchronous methods the real-time replay. Throws
/// nothing: whatever goes wrong is in the result. Reports each call and frame to `signs`.
[[nodiscard]] results::CellResult fly_cell(const CellSpec& spec, VitalSigns& signs);

}  // namespace lodbench::run
