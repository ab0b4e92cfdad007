#pragma once
// The interface between lodbench and a level-of-detail method.
//
// A plugin is a shared object with ONE exported symbol, the constant `lodbench_plugin`: plain data
// that says what the plugin holds, readable without running a line of the plugin's code. Behind
// each entry stands a class derived from `Method`, since host and plugins share a compiler; the
// descriptor carries a tag of compiler, standard library and interface, and a mismatch is refused
// before any call.
//
//     class MyMethod : public lodbench::Method { ... };
//     constexpr lodbench::ParamSpec kParams[] = {lodbench::real_param("tau", 1, 0.01, 100, "...")};
//     constexpr lodbench::MethodDescriptor kMethods[] = {{
//         .id = "my-method", .title = "...", .citation = "...", .version = "1",
//         .params = kParams, .param_count = std::size(kParams), .quality_knob = "tau",
//         .create = lodbench::create_method<MyMethod>}};
//     LODBENCH_PLUGIN(kMethods);
//
// Tags: [once] called once; [gl] the host's context is current; [timed: X] counted as X.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "api/abi_tag.h"
#include "api/camera.h"
#include "api/error.h"
#include "api/params.h"
#include "api/terrain.h"

namespace lodbench {

namespace gl {
class Device;
}

/// Simulated time of a frame: never the wall clock, so that every method sees the same flight.
struct Clock {
    std::int64_t frame = 0;  ///< index on the flight path
    double seconds = 0;      ///< frame / simulated rate
};

/// A method's own figures after a frame, reported beside what was measured from outside.
using Counters = std::vector<std::pair<std::string, double>>;

/// A level-of-detail method. Created, called and destroyed on one thread.
///
/// `select` decides what to draw and freezes it; `draw` draws that frozen selection through any
/// view it is given, any number of times, with identical results. Culling, snapping, tessellation
/// factors and grid mapping depend on the selected camera alone (`Frozen` block), never on the
/// view.
///
/// Every member may throw: the cell then ends as failed, with the plugin, the call and the message.
/// After each call the pipeline state that the host had set (framebuffer, viewport, depth, blend,
/// culling, masks, polygon mode, clip distances, pixel store) must be as it was found; bound
/// program, vertex array, textures and buffers at binding points from 2 up are free.
class Method {
public:
    Method() = default;
    virtual ~Method() = default;
    Method(const Method&) = delete;
    Method& operator=(const Method&) = delete;

    /// Preprocessing. The terrain outlives the method. [once] [gl] [timed: preprocessing]
    virtual void prepare(const Terrain& terrain, gl::Device& device) = 0;

    /// Creates GPU objects. The device outlives the method. [once] [gl] [timed: start-up]
    virtual void upload(gl::Device& device) = 0;

    /// The viewport's size, before the first `select` and whenever it changes. [gl] [timed: never]
    virtual void resize(const Viewport& /*viewport*/) {}

    /// Decides what to draw for this camera. [gl] [timed: select]
    virtual void select(const Camera& camera, const Clock& clock) = 0;

    /// Draws the frozen selection. The uniform blocks `Frame` (this view) and `Frozen` (the
    /// selected camera) are filled and bound by the host; see shaders/common. [gl] [timed: submit,
    /// GPU]
    virtual void draw(const View& view) = 0;

    /// Lockstep: waits until this frame's background work is in the selection. [gl] [timed: never]
    virtual void settle() {}

    /// Around a capture: no background work changes the selection between the two. [timed: never]
    virtual void pause_background() {}
    virtual void resume_background() {}

    /// The method's own figures for the last frame. [timed: never]
    [[nodiscard]] virtual Counters counters() const { return {}; }

    /// Gives all GPU objects back. [once] [gl] [timed: never]
    virtual void release(gl::Device& device) = 0;
};

/// What a method can do or needs, as bits of `MethodDescriptor::capabilities`.
enum Capability : std::uint32_t {
    kAsynchronous = 1U << 0,  ///< has background work: settle and pause/resume mean something
    kOutOfCore = 1U << 1,     ///< does not hold the whole terrain in memory
    kSkirts = 1U << 2,        ///< may draw vertical skirts
    kExample = 1U << 3,       ///< flown only when it is named, never as one of "all methods"
};

/// Why `create` gave no method.
struct CreateError {
    char message[512] = {};
};

/// One method of a plugin. Plain data with static storage; strings are UTF-8 and never null unless
/// said so.
struct MethodDescriptor {
    const char* id;                    ///< [a-z0-9-]+, unique among all plugins
    const char* title;                 ///< one line
    const char* citation;              ///< authors, year, title; "" for a baseline without a paper
    const char* version;               ///< changes whenever results may change
    std::uint32_t capabilities;        ///< bits of Capability
    const char* const* gl_extensions;  ///< beyond OpenGL 4.5 core, null-terminated; may be nullptr
    const ParamSpec* params;
    std::size_t param_count;
    const char* quality_knob;   ///< name of a parameter; nullptr where the method is exact
    const char* claimed_bound;  ///< parameter that bounds the screen error in pixels; nullptr: none
    /// A new method, or nullptr with the reason in `error`. Never throws.
    Method* (*create)(const Params& params, CreateError* error) noexcept;
    void (*destroy)(Method* method) noexcept;
};

// How the compiler was called, of what decides about times: "optimised", "not optimised,
// assertions".
#ifdef __OPTIMIZE__
#define LODBENCH_COMPILED_OPTIMISED "optimised"
#else
#define LODBENCH_COMPILED_OPTIMISED "not optimised"
#endif
#ifdef NDEBUG
#define LODBENCH_COMPILED_ASSERTIONS ""
#else
#define LODBENCH_COMPILED_ASSERTIONS ", assertions"
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LODBENCH_COMPILED_SANITISERS ", sanitisers"
#else
#define LODBENCH_COMPILED_SANITISERS ""
#endif
#define LODBENCH_COMPILED \
    LODBENCH_COMPILED_OPTIMISED LODBENCH_COMPILED_ASSERTIONS LODBENCH_COMPILED_SANITISERS

/// The exported constant. `abi`, `struct_size` and `abi_tag` come first in every version.
struct PluginDescriptor {
    std::uint32_t abi;
    std::uint32_t struct_size;
    const char* abi_tag;
    const MethodDescriptor* methods;
    std::size_t method_count;
    std::size_t method_stride;  ///< sizeof(MethodDescriptor)
    const char* compiled;       ///< LODBENCH_COMPILED where the descriptor stands
};

inline constexpr std::uint32_t kAbi = 1;
inline constexpr const char* kPluginSymbol = "lodbench_plugin";

/// `MethodDescriptor::create` for a class with a constructor that takes `const Params&`.
template <typename T>
Method* create_method(const Params& params, CreateError* error) noexcept {
    const auto report = [error](const char* text) {
        std::size_t i = 0;
        for (; text[i] != '\0' && i + 1 < sizeof error->message; ++i) error->message[i] = text[i];
        error->message[i] = '\0';
    };
    try {
        return new T(params);
    } catch (const std::exception& exception) {
        report(exception.what());
    } catch (...) {
        report("threw something that is not a std::exception");
    }
    return nullptr;
}

inline void destroy_method(Method* method) noexcept {
    delete method;
}

}  // namespace lodbench

/// Exports the plugin's methods: `methods` is a constexpr array of MethodDescriptor. Once per
/// plugin.
#define LODBENCH_PLUGIN(methods_)                                                             \
    extern "C" __attribute__((                                                                \
        visibility("default"))) constexpr lodbench::PluginDescriptor lodbench_plugin = {      \
        lodbench::kAbi,      sizeof(lodbench::PluginDescriptor), lodbench::kAbiTag, methods_, \
        std::size(methods_), sizeof(lodbench::MethodDescriptor), LODBENCH_COMPILED}
