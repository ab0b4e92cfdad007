// tess-pow2: Method I of Zhang 2019, section 4.1: the same quadtree and metric as dss, without
// gaps, and with powers of two for factors.

#include <chrono>
#include <optional>
#include <vector>

#include "stitching_strips/block_scene.h"
#include "stitching_strips/methods.h"
#include "stitching_strips/pow2_blocks.h"

namespace lodbench::stitching_strips {
namespace {

class TessPow2 final : public Method {
public:
    explicit TessPow2(const Params& params)
        : options_(params),
          rounding_(params.choice("round") == "up" ? Rounding::up : Rounding::down) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        ground_.emplace(terrain);
        tree_.emplace(terrain, *ground_, 0, options_.error);
        blocks_.emplace(*tree_, rounding_);
    }

    void upload(gl::Device& device) override {
        scene_.upload(device, *ground_, tree_->size());
        ground_.reset();
    }

    void select(const Camera& camera, const Clock&) override {
        const auto begin = std::chrono::steady_clock::now();
        blocks_->update(BlockMetric(options_.metric, camera));
        list_visible(*tree_, blocks_->cut(), options_.frustum(camera), visible_);
        scene_.freeze(blocks_->blocks(), visible_);
        update_ms_ =
            1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    void draw(const View&) override { scene_.draw(); }

    [[nodiscard]] Counters counters() const override {
        const auto blocks = blocks_->blocks();
        double factors = 0;
        for (const TerrainBlock& block : blocks) factors += double(block.inner.x);
        return {{"m_blocks", double(blocks.size())},
                {"m_blocks_drawn", double(visible_.size())},
                {"mean_factor", factors / double(blocks.size())},
                {"splits_changed", double(blocks_->cut().changed())},
                {"splits_forced", double(blocks_->forced())},
                {"update_ms", update_ms_}};
    }

    void release(gl::Device&) override { scene_.release(); }

private:
    BlockOptions options_;
    Rounding rounding_;
    std::optional<GroundHeights> ground_;  ///< until it is uploaded
    std::optional<BlockTree> tree_;
    std::optional<Pow2Blocks> blocks_;
    BlockScene scene_{"tess-pow2"};
    std::vector<int> visible_;  ///< places in the cut's leaves
    double update_ms_ = 0;
};

}  // namespace

Method* create_tess_pow2(const Params& params, CreateError* error) noexcept {
    return create_method<TessPow2>(params, error);
}

}  // namespace lodbench::stitching_strips
