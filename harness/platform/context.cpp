#include "platform/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "api/error.h"

namespace lodbench::platform {

namespace {

std::string text_or_empty(const char* text) {
    return text == nullptr ? std::string() : std::string(text);
}

bool names(std::string_view list, std::string_view extension) {
    for (std::size_t at = list.find(extension); at != std::string_view::npos;
         at = list.find(extension, at + 1)) {
        const std::size_t end = at + extension.size();
        if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' '))
            return true;
    }
    return false;
}

std::string egl_error() {
    const EGLint error = eglGetError();
    switch (error) {
        case EGL_SUCCESS: return "no reason given";
        case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
        case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
        default: return fmt::format("EGL error 0x{:04X}", error);
    }
}

template <typename Function>
Function load(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// A way to a display: an EGL device, or Mesa's surfaceless platform.
struct Candidate {
    int number = 0;
    EGLDeviceEXT device = EGL_NO_DEVICE_EXT;  ///< none: the surfaceless platform
    std::string file;                         ///< driver's file, "software" or "surfaceless"
    bool software = false;                    ///< as far as EGL says
};

std::vector<Candidate> find_candidates(std::string& why_no_devices) {
    std::vector<Candidate> candidates;
    const std::string client = text_or_empty(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
    const auto query_devices = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto query_string = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const bool enumerable =
        names(client, "EGL_EXT_device_base") || names(client, "EGL_EXT_device_enumeration");
    if (enumerable && names(client, "EGL_EXT_platform_device") && query_devices != nullptr) {
        EGLint count = 0;
        if (query_devices(0, nullptr, &count) == EGL_FALSE) count = 0;
        std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(std::max(count, 0)));
        if (devices.empty() || query_devices(count, devices.data(), &count) == EGL_FALSE) {
            why_no_devices = "EGL found no device";
            count = 0;
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            Candidate candidate{static_cast<int>(i), devices[i], "", false};
            if (query_string != nullptr) {
                const std::string extensions =
                    text_or_empty(query_string(devices[i], EGL_EXTENSIONS));
                candidate.software = names(extensions, "EGL_MESA_device_software");
                if (names(extensions, "EGL_EXT_device_drm")) {
                    candidate.file =
                        text_or_empty(query_string(devices[i], EGL_DRM_DEVICE_FILE_EXT));
                }
            }
            if (candidate.file.empty())
                candidate.file = candidate.software ? "software" : "EGL device";
            candidates.push_back(std::move(candidate));
        }
    } else {
        why_no_devices =
            "EGL cannot enumerate devices (EGL_EXT_device_enumeration, EGL_EXT_platform_device)";
    }
    if (names(client, "EGL_MESA_platform_surfaceless")) {
        candidates.push_back(
            {static_cast<int>(candidates.size()), EGL_NO_DEVICE_EXT, "surfaceless", true});
    }
    return candidates;
}

bool is_software(std::string_view renderer) {
    constexpr std::array<std::string_view, 5> kNames = {"llvmpipe", "softpipe", "swrast",
                                                        "Software Rasterizer", "SwiftShader"};
    return std::any_of(kNames.begin(), kNames.end(), [&](std::string_view name) {
        return renderer.find(name) != std::string_view::npos;
    });
}

/// A context that is current. Displays are never terminated: EGL hands the same display to everyone
/// who asks for a device, and terminating it would take it from them too; the process's end does
/// it.
class Opened {
public:
    Opened() = default;
    Opened(Opened&& other) noexcept
        : renderer(std::move(other.renderer)),
          display_(other.display_),
          config_(other.config_),
          context_(std::exchange(other.context_, EGL_NO_CONTEXT)) {}
    Opened& operator=(Opened&& other) noexcept {
        std::swap(renderer, other.renderer);
        std::swap(display_, other.display_);
        std::swap(config_, other.config_);
        std::swap(context_, other.context_);
        return *this;
    }
    ~Opened() {
        if (context_ == EGL_NO_CONTEXT) return;
        if (eglGetCurrentContext() == context_) {
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        eglDestroyContext(display_, context_);
    }

    /// Makes a context current, or says in `failure` what refused.
    static std::optional<Opened> open(const Candidate& candidate, std::string& failure);
    /// A context that shares with this one, not current; EGL_NO_CONTEXT where the driver refuses.
    [[nodiscard]] EGLContext create_context(EGLContext share) const;
    [[nodiscard]] EGLContext context() const { return context_; }
    [[nodiscard]] EGLDisplay display() const { return display_; }

    std::string renderer;

private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLConfig config_ = EGL_NO_CONFIG_KHR;
    EGLContext context_ = EGL_NO_CONTEXT;
};

EGLContext Opened::create_context(EGLContext share) const {
    constexpr std::array<EGLint, 9> kContext = {EGL_CONTEXT_MAJOR_VERSION,
                                                4,
                                                EGL_CONTEXT_MINOR_VERSION,
                                                5,
                                                EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                EGL_CONTEXT_OPENGL_DEBUG,
                                                EGL_TRUE,
                                                EGL_NONE};
    return eglCreateContext(display_, config_, share, kContext.data());
}

std::optional<Opened> Opened::open(const Candidate& candidate, std::string& failure) {
    const auto get_display = load<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (get_display == nullptr) {
        failure = "EGL_EXT_platform_base is missing";
        return std::nullopt;
    }
    Opened opened;
    const bool surfaceless = candidate.device == EGL_NO_DEVICE_EXT;
    opened.display_ = surfaceless
                          ? get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
                          : get_display(EGL_PLATFORM_DEVICE_EXT, candidate.device, nullptr);
    if (opened.display_ == EGL_NO_DISPLAY ||
        eglInitialize(opened.display_, nullptr, nullptr) == EGL_FALSE) {
        failure = "no display: " + egl_error();
        return std::nullopt;
    }
    const std::string extensions = text_or_empty(eglQueryString(opened.display_, EGL_EXTENSIONS));
    if (!names(extensions, "EGL_KHR_surfaceless_context")) {
        failure = "EGL_KHR_surfaceless_context is missing";
        return std::nullopt;
    }
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) {
        failure = "no desktop OpenGL: " + egl_error();
        return std::nullopt;
    }
    if (!names(extensions, "EGL_KHR_no_config_context")) {
        constexpr std::array<EGLint, 5> kWanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                                   EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
        EGLint count = 0;
        if (eglChooseConfig(opened.display_, kWanted.data(), &opened.config_, 1, &count) ==
                EGL_FALSE ||
            count == 0) {
            failure = "no configuration for OpenGL: " + egl_error();
            return std::nullopt;
        }
    }
    opened.context_ = opened.create_context(EGL_NO_CONTEXT);
    if (opened.context_ == EGL_NO_CONTEXT) {
        failure = "no OpenGL 4.5 core context: " + egl_error();
        return std::nullopt;
    }
    if (eglMakeCurrent(opened.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, opened.context_) ==
        EGL_FALSE) {
        failure = "context cannot be made current: " + egl_error();
        return std::nullopt;
    }
    opened.renderer = text_or_empty(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
    return opened;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::optional<int> as_number(const std::string& text) {
    int number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end) return std::nullopt;
    return number;
}

/// The name of a display's device file, "card0"; "" where EGL does not say. Asked of the display,
/// for Mesa's surfaceless platform chooses a device by itself.
std::string device_node(EGLDisplay display) {
    const auto query_display = load<PFNEGLQUERYDISPLAYATTRIBEXTPROC>("eglQueryDisplayAttribEXT");
    const auto query_string = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const std::string client = text_or_empty(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
    EGLAttrib attribute = 0;
    if (!(names(client, "EGL_EXT_device_base") || names(client, "EGL_EXT_device_query")) ||
        query_display == nullptr || query_string == nullptr ||
        query_display(display, EGL_DEVICE_EXT, &attribute) == EGL_FALSE || attribute == 0) {
        return {};
    }
    auto* const device = reinterpret_cast<EGLDeviceEXT>(attribute);
    const std::string extensions = text_or_empty(query_string(device, EGL_EXTENSIONS));
    std::string file;
    if (names(extensions, "EGL_EXT_device_drm")) {
        file = text_or_empty(query_string(device, EGL_DRM_DEVICE_FILE_EXT));
    }
    if (file.empty() && names(extensions, "EGL_EXT_device_drm_render_node")) {
        constexpr EGLint kRenderNodeFile = 0x3377;  // EGL_DRM_RENDER_NODE_FILE_EXT
        file = text_or_empty(query_string(device, kRenderNodeFile));
    }
    return file.substr(file.rfind('/') + 1);
}

/// The UUID of the current context's only device, as GL_EXT_memory_object has it; NVIDIA's driver
/// gives the same to NVML. "" where the driver does not say, or draws on several.
std::string device_uuid() {
    constexpr GLenum kDeviceCount = 0x9596;  // GL_NUM_DEVICE_UUIDS_EXT
    constexpr GLenum kDeviceUuid = 0x9597;   // GL_DEVICE_UUID_EXT
    constexpr std::string_view kExtension = "GL_EXT_memory_object";
    GLint extensions = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &extensions);
    bool offered = false;
    for (GLint i = 0; i < extensions && !offered; ++i) {
        offered =
            kExtension == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i)));
    }
    using GetBytes = void (*)(GLenum, GLuint, GLubyte*);
    const auto get_bytes = load<GetBytes>("glGetUnsignedBytei_vEXT");
    GLint count = 0;
    if (offered) glGetIntegerv(kDeviceCount, &count);
    if (count != 1 || get_bytes == nullptr) return {};
    std::array<GLubyte, 16> bytes{};
    get_bytes(kDeviceUuid, 0, bytes.data());
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const bool dashed = i == 4 || i == 6 || i == 8 || i == 10;
        text += fmt::format("{}{:02x}", dashed ? "-" : "", bytes[i]);
    }
    return text;
}

/// The context is current.
GpuIdentity gpu_of(EGLDisplay display, const std::string& renderer) {
    GpuIdentity gpu;
    gpu.vendor = text_or_empty(reinterpret_cast<const char*>(glGetString(GL_VENDOR)));
    gpu.software = is_software(renderer);
    if (gpu.software) return gpu;
    gpu.node = device_node(display);
    gpu.uuid = device_uuid();
    return gpu;
}

/// What was current before, current again at the end.
class KeepCurrent {
public:
    KeepCurrent() = default;
    ~KeepCurrent() {
        if (context_ != EGL_NO_CONTEXT) eglMakeCurrent(display_, draw_, read_, context_);
    }
    KeepCurrent(const KeepCurrent&) = delete;
    KeepCurrent& operator=(const KeepCurrent&) = delete;

private:
    EGLDisplay display_ = eglGetCurrentDisplay();
    EGLContext context_ = eglGetCurrentContext();
    EGLSurface draw_ = eglGetCurrentSurface(EGL_DRAW);
    EGLSurface read_ = eglGetCurrentSurface(EGL_READ);
};

}  // namespace

std::vector<DeviceEntry> list_devices() {
    const KeepCurrent keep;
    std::string why;
    std::vector<DeviceEntry> entries;
    for (const Candidate& candidate : find_candidates(why)) {
        std::string failure;
        const std::optional<Opened> opened = Opened::open(candidate, failure);
        if (opened) {
            entries.push_back({candidate.number,
                               fmt::format("{} ({})", opened->renderer, candidate.file),
                               is_software(opened->renderer)});
        } else {
            entries.push_back({candidate.number,
                               fmt::format("{} (cannot be used: {})", candidate.file, failure),
                               candidate.software});
        }
    }
    return entries;
}

namespace {

class Sharing final : public gl::SharedContext {
public:
    Sharing(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
    ~Sharing() override { eglDestroyContext(display_, context_); }

    void make_current() override {
        // The bound API is each thread's own.
        if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE ||
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
            throw UnsupportedError("a shared context cannot be made current: " + egl_error());
        }
    }
    void release_current() noexcept override {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglReleaseThread();
    }

private:
    EGLDisplay display_;
    EGLContext context_;
};

}  // namespace

struct Context::Impl {
    Opened opened;
    std::string description;
    GpuIdentity gpu;
};

Context::Context(const std::string& device) : impl_(std::make_unique<Impl>()) {
    if (eglGetCurrentContext() != EGL_NO_CONTEXT) {
        throw ContractError(
            "platform::Context: another context is current on this thread; destroy it first");
    }
    std::string tried;
    const auto note = [&](const std::string& text) { tried += (tried.empty() ? "" : "; ") + text; };
    std::string why_no_devices;
    const std::vector<Candidate> candidates = find_candidates(why_no_devices);
    if (!why_no_devices.empty()) note(why_no_devices);

    const std::optional<int> number = as_number(device);
    // Two rounds: what renders in hardware, then whatever renders. A name may lie in the renderer,
    // which is known only once the context stands.
    for (const bool software : {false, true}) {
        for (const Candidate& candidate : candidates) {
            if (number && candidate.number != *number) continue;
            if (!software && candidate.software) continue;
            std::string failure;
            std::optional<Opened> opened = Opened::open(candidate, failure);
            const std::string label =
                fmt::format("device {} ({})", candidate.number, candidate.file);
            if (!opened) {
                if (software == candidate.software) note(label + ": " + failure);
                continue;
            }
            if (!software && is_software(opened->renderer)) continue;
            const std::string name = fmt::format("{} ({})", opened->renderer, candidate.file);
            if (!number && lower(name).find(lower(device)) == std::string::npos) {
                if (software == is_software(opened->renderer)) {
                    note(fmt::format("{} is '{}', which does not contain '{}'", label,
                                     opened->renderer, device));
                }
                continue;
            }
            impl_->description = name;
            impl_->gpu = gpu_of(opened->display(), opened->renderer);
            impl_->opened = std::move(*opened);
            return;
        }
    }
    if (number && (*number < 0 || static_cast<std::size_t>(*number) >= candidates.size())) {
        note(fmt::format("there is no device {}; numbers end at {}", *number,
                         static_cast<int>(candidates.size()) - 1));
    }
    throw EnvironmentError(
        fmt::format("no OpenGL 4.5 core context{}: {}; install a driver (Debian: libegl1, "
                    "libgl1-mesa-dri) or name another device",
                    device.empty() ? "" : fmt::format(" for device '{}'", device),
                    tried.empty() ? "nothing to try" : tried));
}

Context::~Context() = default;

std::unique_ptr<gl::SharedContext> Context::make_shared() const {
    const Opened& opened = impl_->opened;
    const EGLContext context = opened.create_context(opened.context());
    if (context == EGL_NO_CONTEXT) {
        throw UnsupportedError(fmt::format("{} gives no second context that shares objects: {}",
                                           impl_->description, egl_error()));
    }
    return std::make_unique<Sharing>(opened.display(), context);
}

const std::string& Context::description() const {
    return impl_->description;
}

const GpuIdentity& Context::gpu() const {
    return impl_->gpu;
}

}  // namespace lodbench::platform
