// Not broken itself: every sample of the terrain, tessellated on the GPU out of patches of
// `patch_cells` x `patch_cells` cells. Mesa's software rasteriser draws wrongly what one draw call
// tessellates into more than about 65,000 vertices, while counters and feedback are right;
// `patches_per_draw` keeps below it.

#include <algorithm>
#include <vector>

#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

class Tessellates final : public QuietMethod {
public:
    explicit Tessellates(const lodbench::Params& params)
        : QuietMethod(params),
          patch_cells_(int(params.integer("patch_cells"))),
          patches_per_draw_(int(params.integer("patches_per_draw"))) {}

    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        rows_ = terrain.info().rows;
        columns_ = terrain.info().columns;
        heights_.resize(std::size_t(rows_) * std::size_t(columns_));
        terrain.read({0, 0, rows_, columns_}, heights_);
    }
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(device, "tessellates", lodbench::embedded_shaders(),
                                         {{GL_VERTEX_SHADER, "tessellates.vert"},
                                          {GL_TESS_CONTROL_SHADER, "tessellates.tesc"},
                                          {GL_TESS_EVALUATION_SHADER, "tessellates.tese"},
                                          {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        texture_ = lodbench::gl::Texture(device, "tessellates: heights", GL_TEXTURE_2D, GL_R32F,
                                         columns_, rows_);
        texture_.write(0, 0, 0, columns_, rows_, GL_RED, GL_FLOAT, heights_.data());
        vertices_ = lodbench::gl::VertexArray(device, "tessellates: none");
    }
    void draw(const lodbench::View&) override {
        const auto patches = [this](int samples) {
            return (samples - 1 + patch_cells_ - 1) / patch_cells_;
        };
        texture_.bind(0);
        program_.set("patch_cells", patch_cells_);
        program_.set("patch_columns", patches(columns_));
        const int count = patches(columns_) * patches(rows_);
        for (int first = 0; first < count; first += patches_per_draw_) {
            const int drawn = std::min(patches_per_draw_, count - first);
            // A patch has three control points unless someone asks for another number.
            device_->draw_arrays(program_, vertices_, GL_PATCHES, 3 * first, 3 * drawn);
        }
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        texture_ = {};
        program_ = {};
    }

private:
    int patch_cells_, patches_per_draw_;
    int rows_ = 0, columns_ = 0;
    std::vector<float> heights_;
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::Texture texture_;
    lodbench::gl::VertexArray vertices_;
};

constexpr lodbench::ParamSpec kParams[] = {
    lodbench::integer_param("patch_cells", 64, 1, 64, "cells along a patch's edge"),
    lodbench::integer_param("patches_per_draw", 1'000'000, 1, 1'000'000,
                            "most patches in one draw call")};

constexpr lodbench::MethodDescriptor kMethods[] = {[] {
    lodbench::MethodDescriptor descriptor = quiet_descriptor<Tessellates>("tessellates");
    descriptor.title = "Every sample, tessellated on the GPU";
    descriptor.params = kParams;
    descriptor.param_count = std::size(kParams);
    return descriptor;
}()};

}  // namespace

LODBENCH_PLUGIN(kMethods);
