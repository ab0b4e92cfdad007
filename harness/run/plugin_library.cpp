#include "run/plugin_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <utility>

#include "run/loader_log.h"
#include "run/plugin_descriptor.h"

namespace lodbench::run {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
    loader_log("refused {}: {}", path.string(), why);
    throw InputError(fmt::format("plugin {} cannot be used: {}", path.string(), why));
}

}  // namespace

PluginLibrary::PluginLibrary(const std::filesystem::path& path)
    // Without a slash the loader would search its own folders.
    : path_(std::filesystem::absolute(path)) {
    loader_log("opening {}", path_.string());
    // The code stays mapped: a worker of a thread pool (oneTBB's) may still be on its way out of a
    // plugin's loop when the method is gone, and would return into nothing.
    handle_ = dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle_ == nullptr) {
        const char* words = dlerror();
        refuse(path_,
               fmt::format("the loader says '{}'; build it again against this system's libraries",
                           words == nullptr ? "nothing" : words));
    }
    try {
        descriptor_ = static_cast<const PluginDescriptor*>(dlsym(handle_, kPluginSymbol));
        if (descriptor_ == nullptr) {
            const char* words = dlerror();
            refuse(path_,
                   fmt::format("it exports no symbol '{}' (the loader says '{}'); declare its "
                               "methods with LODBENCH_PLUGIN",
                               kPluginSymbol, words == nullptr ? "nothing" : words));
        }
        loader_log("{}: reading its descriptor", path_.string());
        try {
            for (const MethodInfo& method : read_descriptor(*descriptor_, path_)) {
                loader_log("{}: method '{}', version {}", path_.string(), method.id,
                           method.version);
            }
        } catch (const DescriptorError& error) {
            refuse(path_, error.what());
        }
    } catch (...) {
        dlclose(handle_);
        throw;
    }
}

PluginLibrary::~PluginLibrary() {
    if (handle_ != nullptr) dlclose(handle_);
}

PluginLibrary::PluginLibrary(PluginLibrary&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)),
      descriptor_(std::exchange(other.descriptor_, nullptr)),
      path_(std::move(other.path_)) {}

PluginLibrary& PluginLibrary::operator=(PluginLibrary&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(descriptor_, other.descriptor_);
    std::swap(path_, other.path_);
    return *this;
}

std::vector<MethodInfo> PluginLibrary::methods() const {
    return read_descriptor(*descriptor_, path_);
}

PluginLibrary::MethodPointer PluginLibrary::create(const std::string& id,
                                                   const Params& params) const {
    for (std::size_t i = 0; i < descriptor_->method_count; ++i) {
        const MethodDescriptor& method = descriptor_->methods[i];
        if (id != method.id) continue;
        CreateError error;
        Method* created = method.create(params, &error);
        if (created != nullptr) return MethodPointer(created, Destroy{method.destroy});
        error.message[sizeof error.message - 1] = '\0';
        throw ContractError(error.message[0] == '\0' ? "create gave no method and no reason"
                                                     : error.message);
    }
    throw ContractError(fmt::format("plugin {} holds no method '{}'", path_.string(), id));
}

}  // namespace lodbench::run
