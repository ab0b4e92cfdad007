#pragma once
// Plugins on disk, and the one that is loaded. The library owns the dlopen handle.

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/method.h"
#include "run/settings.h"

namespace lodbench::run {

/// A method's descriptor, copied out of its plugin.
struct ParamInfo {
    std::string name;
    ParamType type = ParamType::real;
    double default_number = 0, minimum = 0, maximum = 0;
    std::string default_choice;
    std::vector<std::string> choices;
    std::string help;
};
struct MethodInfo {
    std::string id, title, citation, version;
    std::uint32_t capabilities = 0;
    std::vector<std::string> gl_extensions;
    std::vector<ParamInfo> params;
    std::string quality_knob, claimed_bound;  ///< "" for none
    std::filesystem::path plugin;
    std::string compiled;  ///< how its plugin was: LODBENCH_COMPILED there
};

/// One plugin file as it was found: its methods, or why it cannot be used (path, the loader's own
/// words, found and expected, remedy).
struct PluginListing {
    std::filesystem::path path;
    std::vector<MethodInfo> methods;  ///< that are used
    std::string refusal;
    std::vector<std::string> left_out = {};  ///< in words: methods that another plugin holds too
};

/// Folders in the order of search: `extra` (--plugin-dir), LODBENCH_PLUGIN_PATH, then next to the
/// executable: the build tree's plugins/ or the installed plugin folder.
[[nodiscard]] std::vector<std::filesystem::path> plugin_folders(
    const std::vector<std::filesystem::path>& extra);

/// Opens each *.so of the folders in a child process of its own, with a time limit: a plugin whose
/// constructor aborts, loops or exits costs its own line. Of two that hold one id, that of the
/// earlier folder is used; in one folder, that which lodbench was built with or, of two such, the
/// one that methods/CMakeLists.txt names first; else neither.
[[nodiscard]] std::vector<PluginListing> list_plugins(
    const std::vector<std::filesystem::path>& folders);
[[nodiscard]] PluginListing list_plugin(
    const std::filesystem::path& plugin,
    std::chrono::milliseconds time_limit = std::chrono::seconds(10));

/// The method with this id. Throws InputError, "WHERE: no method 'ID' was found; known: ...", with
/// the words of each plugin that was refused.
[[nodiscard]] const MethodInfo& find_method(const std::vector<PluginListing>& plugins,
                                            const std::string& id, const std::string& where);

/// A plugin that is open in this process (RTLD_NOW | RTLD_LOCAL). Its code stays mapped until the
/// process ends, for threads that are still leaving it.
class PluginLibrary {
public:
    /// Throws InputError with the refusal in words.
    explicit PluginLibrary(const std::filesystem::path& path);
    ~PluginLibrary();
    PluginLibrary(PluginLibrary&&) noexcept;
    PluginLibrary& operator=(PluginLibrary&&) noexcept;

    [[nodiscard]] std::vector<MethodInfo> methods() const;

    struct Destroy {
        void (*destroy)(Method*) noexcept = nullptr;
        void operator()(Method* method) const { destroy(method); }
    };
    using MethodPointer = std::unique_ptr<Method, Destroy>;
    /// Throws ContractError with the method's own words when create gives none.
    [[nodiscard]] MethodPointer create(const std::string& id, const Params& params) const;

private:
    void* handle_ = nullptr;
    const PluginDescriptor* descriptor_ = nullptr;
    std::filesystem::path path_;
};

/// Checks text settings against the specs and fills in defaults. Throws InputError naming `where`,
/// the parameter, the value and what would be right.
[[nodiscard]] Params make_params(const MethodInfo& method, const Settings& settings,
                                 const std::string& where);

}  // namespace lodbench::run
