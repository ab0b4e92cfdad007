#include "api/method.h"

namespace {

class Nothing final : public lodbench::Method {
public:
    explicit Nothing(const lodbench::Params&) {}
    void prepare(const lodbench::Terrain&, lodbench::gl::Device&) override {}
    void upload(lodbench::gl::Device&) override {}
    void select(const lodbench::Camera&, const lodbench::Clock&) override {}
    void draw(const lodbench::View&) override {}
    void release(lodbench::gl::Device&) override {}
};

constexpr lodbench::MethodDescriptor kMethods[] = {{
    .id = "nothing",
    .title = "Draws nothing: the harness's own cost",
    .citation = "",
    .version = "1",
    .capabilities = 0,
    .gl_extensions = nullptr,
    .params = nullptr,
    .param_count = 0,
    .quality_knob = nullptr,
    .claimed_bound = nullptr,
    .create = lodbench::create_method<Nothing>,
    .destroy = lodbench::destroy_method,
}};

}  // namespace

LODBENCH_PLUGIN(kMethods);
