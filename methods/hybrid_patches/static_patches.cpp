// static-patches: each selected patch as its regular sub-triangulation, the comparator of Loeffler
// 2010, table 2 ("a representative pre-generated patch-based method with a static patch size of 65
// according to Boesch et al. 2009"). One list of triangles serves every patch; one draw call a
// frame.

#include <vector>

#include "gl/device.h"
#include "gl/objects.h"
#include "hybrid_patches/methods.h"
#include "hybrid_patches/patch_scene.h"
#include "hybrid_patches/patch_triangles.h"

namespace lodbench::hybrid_patches {
namespace {

class StaticPatches final : public Method {
public:
    explicit StaticPatches(const Params& params) : scene_(params, "static-patches") {}

    void prepare(const Terrain& terrain, gl::Device&) override { scene_.prepare(terrain); }

    void upload(gl::Device& device) override {
        device_ = &device;
        scene_.upload(device);
        const PatchHierarchy& patches = scene_.hierarchy();
        const std::vector<std::uint16_t> indices =
            regular_triangles(patches.patch(0).triangle, patches.segments(), patches.levels());
        index_count_ = GLsizei(indices.size());
        triangles_ = gl::Buffer(device, "static-patches: triangles",
                                std::span<const std::uint16_t>(indices));
        places_ = gl::Buffer(device, "static-patches: selected patches",
                             patches.size() * sizeof(PatchPlace));
        vertices_ = scene_.vertex_array(device, places_, triangles_);
    }

    void select(const Camera& camera, const Clock&) override {
        const common::RefinerOptions& options = scene_.options();
        const LebView view(scene_.grid(), camera, options.tau, options.metric, 0);
        scene_.hierarchy().select(view, options.metric, options.culling, selected_);
        selected_places_.clear();
        for (const std::uint32_t patch : selected_) selected_places_.push_back(scene_.place(patch));
        if (!selected_.empty()) places_.write(std::span<const PatchPlace>(selected_places_));
    }

    void draw(const View&) override {
        if (selected_.empty()) return;
        device_->draw_elements(scene_.program(), vertices_, GL_TRIANGLES, index_count_,
                               GL_UNSIGNED_SHORT, 0, GLsizei(selected_.size()));
    }

    [[nodiscard]] Counters counters() const override {
        return {{"patches_selected", double(selected_.size())},
                {"patches_total", double(scene_.hierarchy().size())},
                {"triangles", double(selected_.size()) * index_count_ / 3}};
    }

    void release(gl::Device&) override {
        vertices_ = {};
        places_ = {};
        triangles_ = {};
        scene_.release();
    }

private:
    PatchScene scene_;
    gl::Device* device_ = nullptr;
    gl::Buffer triangles_, places_;  ///< indices of a patch's; what is selected
    gl::VertexArray vertices_;
    GLsizei index_count_ = 0;  ///< of a patch
    std::vector<std::uint32_t> selected_;
    std::vector<PatchPlace> selected_places_;
};

}  // namespace

Method* create_static_patches(const Params& params, CreateError* error) noexcept {
    return create_method<StaticPatches>(params, error);
}

}  // namespace lodbench::hybrid_patches
