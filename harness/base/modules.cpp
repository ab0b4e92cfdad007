#include "base/modules.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <mutex>
#include <set>

#include "api/error.h"

namespace lodbench::base {

namespace fs = std::filesystem;

namespace {

std::mutex loaded_mutex;
std::set<std::string> loaded;  // guarded by it

}  // namespace

std::array<fs::path, 2> module_folders() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path base = program.parent_path().parent_path();
    return {base / "modules", base / LODBENCH_MODULE_SUBDIR};
}

void* find_in_module(const std::string& name, const char* symbol) {
    for (const fs::path& folder : module_folders()) {
        const fs::path module = folder / (name + ".so");
        std::error_code error;
        if (!fs::exists(module, error)) continue;
        void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        void* address = handle != nullptr ? dlsym(handle, symbol) : nullptr;
        if (address != nullptr) {
            const std::scoped_lock lock(loaded_mutex);
            loaded.insert(name);
            return address;
        }
        throw EnvironmentError(
            fmt::format("the module {} does not load: {}", module.string(), dlerror()));
    }
    return nullptr;
}

std::vector<std::string> loaded_modules() {
    const std::scoped_lock lock(loaded_mutex);
    return {loaded.begin(), loaded.end()};
}

}  // namespace lodbench::base
