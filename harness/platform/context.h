#pragma once
// The only door to a GL context: EGL, a hardware device first, surfaceless software as fallback.

#include <memory>
#include <string>
#include <vector>

#include "gl/shared_context.h"

namespace lodbench::platform {

/// One EGL device as `lodbench list --devices` shows it.
struct DeviceEntry {
    int number = 0;
    std::string name;  ///< renderer where it can be asked, else the driver's file or "software"
    bool software = false;
};

[[nodiscard]] std::vector<DeviceEntry> list_devices();

/// Which GPU a context draws on, as far as its driver says: what finds the GPU's sensors.
struct GpuIdentity {
    std::string node;    ///< name of its file in /dev/dri: "card0", "renderD128"; "" where not said
    std::string uuid;    ///< 8-4-4-4-12 hex digits (GL_EXT_memory_object); "" where not said
    std::string vendor;  ///< GL_VENDOR
    bool software = false;
};

/// An OpenGL 4.5 core debug context without a surface, current on the creating thread until
/// destroyed.
class Context {
public:
    /// `device`: "" for the best (hardware, then software), a number of list_devices(), or a part
    /// of a name. Throws EnvironmentError with everything that was tried and what each attempt
    /// said, ContractError while another context is current on this thread.
    explicit Context(const std::string& device = "");
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// A further context of the same device, not yet current, that shares objects with this one;
    /// this one outlives it. Throws UnsupportedError with the driver's words.
    [[nodiscard]] std::unique_ptr<gl::SharedContext> make_shared() const;

    /// What was chosen, in words.
    [[nodiscard]] const std::string& description() const;
    [[nodiscard]] const GpuIdentity& gpu() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lodbench::platform
