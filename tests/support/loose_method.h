#pragma once
// A method over any terrain, called without a stage: for terrains that are not in memory, and to
// time single calls.

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "gl/device.h"
#include "gl/frame_blocks.h"
#include "platform/context.h"
#include "run/plugin_library.h"

namespace lodbench::test {

class LooseMethod {
public:
    using Settings = std::vector<std::pair<std::string, std::string>>;

    LooseMethod(const Terrain& terrain, const std::string& plugin, const std::string& method,
                const Settings& settings)
        : terrain_(terrain), library_(std::string(LODBENCH_PLUGINS) + "/" + plugin + ".so") {
        const run::MethodInfo info =
            run::find_method({{plugin + ".so", library_.methods(), ""}}, method, "test");
        method_ = library_.create(method, run::make_params(info, settings, "test"));
        frozen_ = gl::Buffer(device_, "test: Frozen", sizeof(gl::Frozen));
        method_->prepare(terrain, device_);
        method_->upload(device_);
    }
    ~LooseMethod() { method_->release(device_); }
    LooseMethod(const LooseMethod&) = delete;
    LooseMethod& operator=(const LooseMethod&) = delete;

    /// Seconds.
    double select(const Camera& camera) {
        const gl::Frozen block = gl::make_frozen(camera, terrain_.info());
        frozen_.write(0, sizeof block, &block);
        frozen_.bind_uniform(gl::kFrozenBinding);
        const auto begin = std::chrono::steady_clock::now();
        method_->select(camera, {});
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    [[nodiscard]] double counter(const std::string& name) const {
        for (const auto& [key, value] : method_->counters()) {
            if (key == name) return value;
        }
        throw ContractError("no counter " + name);
    }
    [[nodiscard]] Method& method() { return *method_; }

private:
    const Terrain& terrain_;
    platform::Context context_{""};
    gl::Device device_;
    run::PluginLibrary library_;
    gl::Buffer frozen_;
    run::PluginLibrary::MethodPointer method_;
};

}  // namespace lodbench::test
