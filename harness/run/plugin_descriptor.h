#pragma once
// Reads a plugin's descriptor: plain data, checked before a line of the plugin's code is called.

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "api/method.h"
#include "run/plugin_library.h"

namespace lodbench::run {

/// What is wrong with a descriptor: found, expected and remedy, without the plugin's path.
struct DescriptorError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Checks abi, struct_size and abi_tag, in that order, and only then what lies behind them; copies
/// the methods out. Throws DescriptorError.
[[nodiscard]] std::vector<MethodInfo> read_descriptor(const PluginDescriptor& descriptor,
                                                      const std::filesystem::path& plugin);

}  // namespace lodbench::run
