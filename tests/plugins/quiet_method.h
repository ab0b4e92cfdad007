#pragma once
// A method that does nothing, from which each broken plugin differs in its one fault.

#include "api/method.h"
#include "gl/device.h"

class QuietMethod : public lodbench::Method {
public:
    explicit QuietMethod(const lodbench::Params&) {}
    void prepare(const lodbench::Terrain&, lodbench::gl::Device&) override {}
    void upload(lodbench::gl::Device&) override {}
    void select(const lodbench::Camera&, const lodbench::Clock&) override {}
    void draw(const lodbench::View&) override {}
    void release(lodbench::gl::Device&) override {}
};

template <typename T>
constexpr lodbench::MethodDescriptor quiet_descriptor(const char* id) {
    return {.id = id,
            .title = "Broken on purpose",
            .citation = "",
            .version = "1",
            .capabilities = 0,
            .gl_extensions = nullptr,
            .params = nullptr,
            .param_count = 0,
            .quality_knob = nullptr,
            .claimed_bound = nullptr,
            .create = lodbench::create_method<T>,
            .destroy = lodbench::destroy_method};
}

/// Exports the class as the plugin's one method.
#define QUIET_PLUGIN(class_, id_)                                                      \
    namespace {                                                                        \
    constexpr lodbench::MethodDescriptor kMethods[] = {quiet_descriptor<class_>(id_)}; \
    }                                                                                  \
    LODBENCH_PLUGIN(kMethods)
