#pragma once
// Modules: shared objects of the program itself, for libraries that few processes need. GDAL and
// OpenImageIO bring some 260 shared libraries with them; behind a module, a process pays for them
// when it calls one and not before.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace lodbench::base {

/// Where modules are looked for, in order: modules/ beside the build tree's bin/, the installed
/// folder.
[[nodiscard]] std::array<std::filesystem::path, 2> module_folders();

/// Address of the function `symbol` of the module `name`.so, which stays loaded: such libraries
/// cannot be unloaded and loaded again safely. nullptr where there is no module of this name: it
/// was not built, or not installed. Throws EnvironmentError, with the loader's words, where it is
/// there but does not load.
[[nodiscard]] void* find_in_module(const std::string& name, const char* symbol);

/// Names of the modules that this process has loaded, in alphabetical order.
[[nodiscard]] std::vector<std::string> loaded_modules();

}  // namespace lodbench::base
