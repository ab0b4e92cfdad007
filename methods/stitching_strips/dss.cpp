// dss: Zhang 2019. Blocks of a quadtree, tessellated with a continuous factor each, and between
// them strips that the CPU makes anew in every frame. Deviations: see README.md.

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "stitching_strips/block_scene.h"
#include "stitching_strips/methods.h"
#include "stitching_strips/strip_builder.h"

namespace lodbench::stitching_strips {
namespace {

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class Dss final : public Method {
public:
    explicit Dss(const Params& params)
        : options_(params),
          strip_width_(int(params.integer("strip_width"))),
          threads_(int(params.integer("threads"))) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        ground_.emplace(terrain);
        tree_.emplace(terrain, *ground_, strip_width_ == 0 ? BlockLayout::kSegment : strip_width_,
                      options_.error);
        cut_.emplace(*tree_);
        strips_.emplace(*tree_, threads_);
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        scene_.upload(device, *ground_, tree_->size());
        ground_.reset();
        program_ = strip_program(device);
    }

    void select(const Camera& camera, const Clock&) override {
        const auto begin = std::chrono::steady_clock::now();
        const auto frustum = options_.frustum(camera);
        cut_->update(BlockMetric(options_.metric, camera));
        list_visible(*tree_, *cut_, frustum, visible_);
        update_ms_ = milliseconds_since(begin);
        strips_->build(*cut_, frustum);
        const auto built = std::chrono::steady_clock::now();
        freeze();
        upload_ms_ = milliseconds_since(built);
    }

    void draw(const View&) override {
        scene_.draw();
        const auto count = GLsizei(strips_->indices().size());
        if (count == 0) return;
        device_->draw_elements(program_, vertices_, GL_TRIANGLES, count, GL_UNSIGNED_INT, 0);
    }

    [[nodiscard]] Counters counters() const override {
        const StripBuilder::Seconds& seconds = strips_->seconds();
        const auto leaves = cut_->leaves();
        double factors = 0;
        for (const Leaf& leaf : leaves) factors += double(leaf.factor);
        return {{"m_blocks", double(leaves.size())},
                {"m_blocks_drawn", double(visible_.size())},
                {"p_blocks_drawn", double(strips_->patch_count())},
                {"strips_drawn", double(strips_->strip_count())},
                {"strip_stretches", double(strips_->stretch_count())},
                {"strip_vertices", double(strips_->vertices().size())},
                {"strip_triangles", double(strips_->strip_triangles())},
                {"mean_factor", factors / double(leaves.size())},
                {"splits_changed", double(cut_->changed())},
                {"update_ms", update_ms_},
                {"strips_listing_ms", 1e3 * seconds.listing},
                {"strips_vertices_ms", 1e3 * seconds.vertices},
                {"strips_triangles_ms", 1e3 * seconds.triangles},
                {"strips_upload_ms", upload_ms_},
                {"strips_ms", 1e3 * (seconds.listing + seconds.vertices + seconds.triangles)}};
    }

    void release(gl::Device&) override {
        scene_.release();
        vertices_ = {};
        vertex_buffer_ = {};
        index_buffer_ = {};
        program_ = {};
    }

private:
    /// In software through a geometry shader, which says why.
    static gl::Program strip_program(gl::Device& device) {
        if (!device.info().software) {
            return {
                device,
                "dss: strips",
                embedded_shaders(),
                {{GL_VERTEX_SHADER, "strip.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}}};
        }
        return {device,
                "dss: strips",
                embedded_shaders(),
                {{GL_VERTEX_SHADER, "strip.vert"},
                 {GL_GEOMETRY_SHADER, "strip.geom"},
                 {GL_FRAGMENT_SHADER, "common/terrain.frag"}},
                {{"THROUGH_GEOMETRY", "1"}}};
    }

    void freeze() {
        blocks_.clear();
        for (const Leaf& leaf : cut_->leaves()) {
            const Square& square = tree_->block(leaf.block).square;
            blocks_.push_back(
                {{square.corner, square.side, 0}, glm::vec4(leaf.factor), glm::vec4(leaf.factor)});
        }
        scene_.freeze(blocks_, visible_);
        if (strips_->indices().empty()) return;
        make_room();
        vertex_buffer_.write(strips_->vertices());
        index_buffer_.write(strips_->indices());
    }

    /// As much again where a buffer is too small: how much a frame needs is not known before.
    void make_room() {
        const std::size_t vertices = strips_->vertices().size_bytes();
        const std::size_t indices = strips_->indices().size_bytes();
        if (vertices <= vertex_buffer_.bytes() && indices <= index_buffer_.bytes()) return;
        const auto enough = [](std::size_t now, std::size_t needed) {
            return now >= needed ? now : std::max(2 * now, needed);
        };
        const std::size_t vertex_bytes = enough(vertex_buffer_.bytes(), vertices);
        const std::size_t index_bytes = enough(index_buffer_.bytes(), indices);
        vertices_ = {};
        vertex_buffer_ = {};
        index_buffer_ = {};
        vertex_buffer_ = gl::Buffer(*device_, "dss: strip vertices", vertex_bytes);
        index_buffer_ = gl::Buffer(*device_, "dss: strip triangles", index_bytes);
        vertices_ = gl::VertexArray(*device_, "dss: strips");
        vertices_.integer_attribute(0, 2, GL_UNSIGNED_INT, vertex_buffer_, 0, sizeof(StripVertex));
        vertices_.elements(index_buffer_);
    }

    BlockOptions options_;
    int strip_width_, threads_;
    std::optional<GroundHeights> ground_;  ///< until it is uploaded
    std::optional<BlockTree> tree_;
    std::optional<BlockCut> cut_;
    std::optional<StripBuilder> strips_;
    gl::Device* device_ = nullptr;
    BlockScene scene_{"dss"};
    gl::Program program_;
    gl::Buffer vertex_buffer_, index_buffer_;
    gl::VertexArray vertices_;
    std::vector<int> visible_;  ///< places in the cut's leaves
    std::vector<TerrainBlock> blocks_;
    double update_ms_ = 0, upload_ms_ = 0;
};

}  // namespace

Method* create_dss(const Params& params, CreateError* error) noexcept {
    return create_method<Dss>(params, error);
}

}  // namespace lodbench::stitching_strips
