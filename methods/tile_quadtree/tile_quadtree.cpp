// dltq, sltq-gpu, sltq-cpu, fu: tiles of 65 x 65 samples, chosen by a quadtree. Ying Yang, Chunfang
// Wang, Yuyu Gao, Jingwei Xing: Large Scale Terrain Real-Time Rendering on GPU Using Double Layers
// Tile Quad Tree and Cuboids Bounding Error Metric (2016). Deviations: see README.md.
//
// The steps of a frame, figure 1: where is visible ground (tile_scene, visible region), which tiles
// are there (visible_tiles), which of them split (tile_decisions, or tile_metric on the CPU), which
// are drawn (tile_tree, tile_cut), and are they in memory (common/tile_streamer).

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/tile_streamer.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "tile_quadtree/methods.h"
#include "tile_quadtree/resident_errors.h"
#include "tile_quadtree/tile_cut.h"
#include "tile_quadtree/tile_decisions.h"
#include "tile_quadtree/tile_scene.h"
#include "tile_quadtree/tile_selection.h"

namespace lodbench::tile_quadtree {
namespace {

enum class Kind { dltq, sltq_gpu, sltq_cpu, fu };

SharedHeight shared_height(const Params& params) {
    const std::string& name = params.choice("shared_height");
    return name == "range"      ? SharedHeight::range
           : name == "triangle" ? SharedHeight::triangle
                                : SharedHeight::none;
}

struct Options {
    Kind kind;
    MetricOptions metric;
    double tau;
    bool culling, by_compute, sync, prune, shortcut, resident_errors;
    int upper_levels, prefetch_frames, region_pixels;
    Cracks cracks;
    common::TileStreamerOptions streaming;

    Options(Kind method, const Params& params)
        : kind(method),
          metric(method == Kind::fu ? fu_metric(shared_height(params))
                                    : MetricOptions{.shared = shared_height(params)}),
          tau(params.real("tau")),
          culling(params.boolean("culling")),
          by_compute(on_gpu() && params.choice("evaluate") == "compute"),
          sync(on_gpu() && params.boolean("sync")),
          prune(method == Kind::dltq && params.boolean("prune")),
          shortcut(!on_gpu() && params.boolean("shortcut")),
          resident_errors((method == Kind::dltq || method == Kind::sltq_gpu) &&
                          params.choice("errors") == "gpu"),
          upper_levels(method == Kind::dltq ? int(params.integer("upper_levels")) : 0),
          prefetch_frames(int(params.integer("prefetch"))),
          region_pixels(on_gpu() ? int(params.integer("region_pixels")) : 1),
          cracks(params.choice("cracks") == "snap"    ? Cracks::snap
                 : params.choice("cracks") == "skirt" ? Cracks::skirt
                                                      : Cracks::none),
          streaming{.slots = int(params.integer("pool_tiles")),
                    .loader_threads = int(params.integer("loader_threads")),
                    .uploads_per_frame = int(params.integer("uploads_per_frame"))} {
        if (resident_errors && metric.shared == SharedHeight::range) {
            throw InputError(
                "errors = \"gpu\" does not go with shared_height = \"range\": a tile's height "
                "range is that of samples which are not resident; choose shared_height = \"none\" "
                "or \"triangle\", or errors = \"summaries\"");
        }
    }
    [[nodiscard]] bool on_gpu() const { return kind != Kind::sltq_cpu; }
};

/// What was counted of the last selection.
struct FrameCounts {
    std::size_t tested = 0;    ///< tiles that were asked whether they are visible
    std::size_t judged = 0;    ///< tiles that were decided on
    std::size_t resident = 0;  ///< of them, those whose error came from resident heights
    std::size_t wanted = 0;    ///< tiles that the decisions ask for
    std::size_t missing = 0;   ///< of them, those that were not resident
    int drawn = 0, stand_ins = 0, refused = 0;
    double collecting_s = 0, deciding_s = 0, streaming_s = 0;  ///< wall clock
};

/// Adds the seconds of its life to a sum.
class Spent {
public:
    explicit Spent(double& sum) : sum_(sum) {}
    ~Spent() { sum_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
    Spent(const Spent&) = delete;
    Spent& operator=(const Spent&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    double& sum_;
    Clock::time_point begin_ = Clock::now();
};

class TileQuadtree : public Method {
public:
    TileQuadtree(Kind kind, const Params& params) : options_(kind, params) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        catalogue_.emplace(terrain);
        metric_.emplace(terrain, *catalogue_, options_.metric);
        if (options_.kind == Kind::dltq) layers_.emplace(*catalogue_, options_.upper_levels);
        decisions_.emplace(catalogue_->pyramid().count());
        cut_.emplace(*catalogue_);
        needed_.assign(catalogue_->pyramid().count(), false);
        streamer_.emplace(terrain, options_.streaming);
    }

    void upload(gl::Device& device) override {
        scene_.emplace(options_.cracks, options_.region_pixels);
        scene_->upload(device, embedded_shaders(), options_.streaming.slots);
        if (options_.on_gpu()) {
            judges_.upload(device, embedded_shaders(), options_.metric, options_.by_compute,
                           options_.resident_errors);
        }
        if (options_.resident_errors) {
            errors_.upload(device, embedded_shaders(), options_.streaming.slots);
        }
        streamer_->upload(device, "tile_quadtree: heights of the pool");
    }

    void select(const Camera& camera, const Clock&) override {
        const std::optional<glm::dvec3> before = eye_;
        camera_ = camera;
        eye_ = camera.position;
        counts_ = {};
        if (settled_) {
            select_exactly();
            return;
        }
        const TileView view(camera, options_.tau, options_.culling);
        TileTree tree;
        if (!options_.on_gpu()) {
            tree = tree_on_cpu(view);
        } else {
            if (options_.sync) {
                ask_region();
                take_region(view);
                ask_decisions(view);
                take_decisions();
            } else {
                if (scene_->region_arrived()) take_region(view);
                if (judges_.arrived()) take_decisions();
            }
            tree = tree_of_decisions(view, region_);
        }
        const glm::dvec3 step = before ? camera.position - *before : glm::dvec3(0);
        stream(tree, step);
        if (options_.on_gpu() && !options_.sync) {
            // For the next frame. One that is still on its way is not overtaken.
            if (!scene_->region_pending()) ask_region();
            if (!judges_.pending()) ask_decisions(view);
        }
    }

    /// From the first call on every `select` is exact: decided for its own camera, with all tiles
    /// that it asks for. What came before depends on the clock, and is forgotten.
    void settle() override {
        if (settled_) return;
        settled_ = true;
        scene_->forget_region();
        judges_.forget();
        streamer_->forget();
        select_exactly();
    }

    void draw(const View&) override { scene_->draw(*streamer_); }

    void pause_background() override { streamer_->pause(); }
    void resume_background() override { streamer_->resume(); }

    [[nodiscard]] Counters counters() const override {
        const common::TileStreamerCounts& streamed = streamer_->counts();
        return {{"tiles_drawn", double(counts_.drawn)},
                {"ancestors_drawn", double(counts_.stand_ins)},
                {"tiles_tested", double(counts_.tested)},
                {"tiles_judged", double(counts_.judged)},
                {"errors_from_heights", double(counts_.resident)},
                {"tiles_wanted", double(counts_.wanted)},
                {"tiles_missing", double(counts_.missing)},
                {"splits_refused", double(counts_.refused)},
                {"tiles_resident", double(streamer_->resident())},
                {"collecting_ms", 1e3 * counts_.collecting_s},
                {"deciding_ms", 1e3 * counts_.deciding_s},
                {"streaming_ms", 1e3 * counts_.streaming_s},
                {"errors_computed_so_far", double(errors_.computed_count())},
                {"pool_hits_so_far", double(streamed.hits)},
                {"pool_misses_so_far", double(streamed.misses())},
                {"tiles_needed_so_far", double(needed_count_)},
                {"tiles_uploaded_so_far", double(streamed.uploaded)},
                {"tiles_prefetched_so_far", double(streamed.prefetched)},
                {"tiles_dropped_so_far", double(streamed.dropped)},
                {"tile_bytes_uploaded_so_far", double(streamed.bytes())}};
    }

    void release(gl::Device&) override {
        streamer_->release();
        judges_.release();
        errors_.release();
        scene_->release();
    }

private:
    /// The root has its slot for good.
    [[nodiscard]] int most_leaves() const { return options_.streaming.slots - 1; }

    void ask_region() {
        const Spent spent(counts_.collecting_s);
        scene_->ask_region(*streamer_);
    }

    /// Where nothing was seen though something may be in view, what was drawn may be too wrong to
    /// tell: from within a valley, the root's surface lies above the eye. Then all is taken as
    /// visible.
    void take_region(const TileView& view) {
        const Spent spent(counts_.collecting_s);
        region_ = scene_->region(*catalogue_);
        if (region_.empty() && view.may_see(*catalogue_, catalogue_->pyramid().root())) {
            region_ = catalogue_->whole();
        }
    }

    void ask_decisions(const TileView& view) {
        VisibleTiles visible = visible_tiles(view);
        const Spent spent(counts_.deciding_s);
        summaries_.clear();
        for (const TileId& tile : visible.tiles) summaries_.push_back(summary_of(tile));
        if (options_.resident_errors) {
            errors_.compute(*streamer_);
            errors_.shares().bind(3);
        }
        judges_.ask(view.scale, std::move(visible.tiles), summaries_);
    }
    [[nodiscard]] VisibleTiles visible_tiles(const TileView& view) {
        const Spent spent(counts_.collecting_s);
        VisibleTiles visible;
        if (layers_) {
            layers_->collect(
                region_, [&](const TileId& root) { return !options_.prune || reached(root, view); },
                visible);
        } else {
            collect_from_one_tree(*catalogue_, region_, visible);
        }
        counts_.tested = visible.tested;
        counts_.judged = visible.tiles.size();
        counts_.resident = 0;
        return visible;
    }
    /// As the GPU takes it.
    [[nodiscard]] glm::vec4 summary_of(const TileId& tile) {
        glm::vec4 packed = metric_->packed(tile);
        if (!options_.resident_errors) return packed;
        if (const auto children = errors_.children(*catalogue_, *streamer_, tile)) {
            const auto [first, second] = children->packed();
            packed.z = first;
            packed.w = second;
            ++counts_.resident;
        }
        return packed;
    }
    /// Whether the tile and all above it split. One part in 10^4 more is let through, so that the
    /// GPU, which has the last word, is asked wherever its rounding may decide otherwise.
    [[nodiscard]] bool reached(TileId tile, const TileView& view) const {
        for (; catalogue_->pyramid().contains(tile);
             tile = {tile.level + 1, tile.row / 2, tile.column / 2}) {
            const Judgement judgement = metric_->judge(tile, view.eye, view.scale);
            if (judgement.reach * (1 + 1e-4) <= judgement.distance) return false;
        }
        return true;
    }
    void take_decisions() {
        const Spent spent(counts_.deciding_s);
        const auto [tiles, splits] = judges_.answers();
        decisions_->assign(*catalogue_, tiles, splits);
    }
    [[nodiscard]] TileTree tree_of_decisions(const TileView& view, const SampleBox& region) {
        const Spent spent(counts_.streaming_s);
        return tree_by_decisions(*catalogue_, *metric_, *decisions_, region, view, most_leaves());
    }

    /// `sltq-cpu`: as the paper's, all tiles in view are judged; by the shortcut, those alone whose
    /// ancestors split.
    [[nodiscard]] TileTree tree_on_cpu(const TileView& view) {
        if (options_.shortcut) {
            const Spent spent(counts_.deciding_s);
            TileTree tree = tree_by_cpu(*catalogue_, *metric_, view, most_leaves());
            counts_.tested = counts_.judged = tree.nodes.size();
            return tree;
        }
        const VisibleTiles visible = tiles_in_view(view);
        judge_on_cpu(visible.tiles, view);
        return tree_of_decisions(view, catalogue_->whole());
    }
    [[nodiscard]] VisibleTiles tiles_in_view(const TileView& view) {
        const Spent spent(counts_.collecting_s);
        VisibleTiles visible;
        collect_from_one_tree(
            *catalogue_, [&](const TileId& tile) { return view.may_see(*catalogue_, tile); },
            catalogue_->pyramid().root(), visible);
        counts_.tested = visible.tested;
        counts_.judged = visible.tiles.size();
        return visible;
    }
    void judge_on_cpu(const std::vector<TileId>& tiles, const TileView& view) {
        const Spent spent(counts_.deciding_s);
        std::vector<std::uint8_t> splits;
        splits.reserve(tiles.size());
        for (const TileId& tile : tiles) {
            splits.push_back(metric_->splits(tile, view.eye, view.scale) ? 1 : 0);
        }
        decisions_->assign(*catalogue_, tiles, splits);
    }

    /// Draws what is resident and asks for what is not. `step`: the way from the frame before,
    /// metres.
    void stream(const TileTree& tree, const glm::dvec3& step) {
        const Spent spent(counts_.streaming_s);
        const std::vector<DrawnTile> wanted = cut_->build(tree, [](const TileId&) { return true; });
        note_needed(wanted);
        std::vector<TileId> leaves, ancestors, soon;
        for (const DrawnTile& tile : wanted) leaves.push_back(tile.tile);
        for (const TileId& tile : leaves) {
            if (streamer_->slot(tile)) continue;
            ++counts_.missing;
            TileId above = tile;
            while (above.level + 1 < catalogue_->pyramid().root().level) {
                above = {above.level + 1, above.row / 2, above.column / 2};
                ancestors.push_back(above);
            }
        }
        const auto index = [this](const TileId& tile) { return catalogue_->index(tile); };
        // Coarse ones first, each once: the index grows towards coarser levels.
        std::ranges::sort(ancestors, std::ranges::greater{}, index);
        const auto [again, end] = std::ranges::unique(ancestors);
        ancestors.erase(again, end);
        if (counts_.missing == 0) soon = needed_soon(step);
        streamer_->update({leaves, ancestors, soon});
        freeze(cut_->build(
                   tree, [this](const TileId& tile) { return streamer_->slot(tile).has_value(); }),
               tree);
    }

    /// What the viewpoint will ask for if it goes on like this.
    [[nodiscard]] std::vector<TileId> needed_soon(const glm::dvec3& step) const {
        if (options_.prefetch_frames == 0 || step == glm::dvec3(0)) return {};
        Camera ahead = camera_;
        ahead.position += double(options_.prefetch_frames) * step;
        const TileTree tree = tree_by_cpu(
            *catalogue_, *metric_, TileView(ahead, options_.tau, options_.culling), most_leaves());
        return tree.leaves();
    }

    /// For the camera as it is, whatever was drawn before, with everything resident.
    void select_exactly() {
        counts_ = {};
        const TileView view(camera_, options_.tau, options_.culling);
        TileTree tree;
        if (options_.on_gpu()) {
            // Whatever is drawn now shows this camera's ground as it is: the region does not depend
            // on the frame before.
            load_and_freeze(tree_by_cpu(*catalogue_, *metric_, view, most_leaves()));
            ask_region();
            region_ = scene_->region(*catalogue_);
            ask_decisions(view);
            take_decisions();
            tree = tree_of_decisions(view, region_);
        } else {
            tree = tree_on_cpu(view);
        }
        load_and_freeze(tree);
        note_needed(drawn_);
    }
    void load_and_freeze(const TileTree& tree) {
        const Spent spent(counts_.streaming_s);
        std::vector<DrawnTile> drawn = cut_->build(tree, [](const TileId&) { return true; });
        std::vector<TileId> tiles;
        for (const DrawnTile& tile : drawn) tiles.push_back(tile.tile);
        streamer_->load(tiles);
        freeze(std::move(drawn), tree);
    }

    void freeze(std::vector<DrawnTile> drawn, const TileTree& tree) {
        drawn_ = std::move(drawn);
        scene_->freeze(drawn_, *catalogue_, *streamer_);
        counts_.drawn = int(drawn_.size());
        counts_.stand_ins = int(std::ranges::count(drawn_, true, &DrawnTile::stands_in));
        counts_.refused = tree.refused;
    }
    void note_needed(const std::vector<DrawnTile>& wanted) {
        counts_.wanted = wanted.size();
        for (const DrawnTile& tile : wanted) {
            std::vector<bool>::reference needed = needed_[catalogue_->index(tile.tile)];
            needed_count_ += needed ? 0 : 1;
            needed = true;
        }
    }

    Options options_;
    std::optional<TileCatalogue> catalogue_;
    std::optional<TileMetric> metric_;
    std::optional<DoubleLayerTree> layers_;  ///< dltq
    std::optional<DecisionTable> decisions_;
    std::optional<CutBuilder> cut_;
    std::optional<common::TileStreamer> streamer_;
    std::optional<TileScene> scene_;
    TileDecisions judges_;
    ResidentErrors errors_;
    std::vector<glm::vec4> summaries_;  ///< of the tiles that are asked about
    SampleBox region_;
    Camera camera_;
    std::optional<glm::dvec3> eye_;  ///< of the last frame
    bool settled_ = false;
    std::vector<DrawnTile> drawn_;
    FrameCounts counts_;
    std::vector<bool> needed_;  ///< by index: tiles that a frame has asked for
    std::size_t needed_count_ = 0;
};

/// create_method wants a class that takes the parameters alone.
template <Kind kind>
class TileQuadtreeOf final : public TileQuadtree {
public:
    explicit TileQuadtreeOf(const Params& params) : TileQuadtree(kind, params) {}
};

}  // namespace

Method* create_dltq(const Params& params, CreateError* error) noexcept {
    return create_method<TileQuadtreeOf<Kind::dltq>>(params, error);
}
Method* create_sltq_gpu(const Params& params, CreateError* error) noexcept {
    return create_method<TileQuadtreeOf<Kind::sltq_gpu>>(params, error);
}
Method* create_sltq_cpu(const Params& params, CreateError* error) noexcept {
    return create_method<TileQuadtreeOf<Kind::sltq_cpu>>(params, error);
}
Method* create_fu(const Params& params, CreateError* error) noexcept {
    return create_method<TileQuadtreeOf<Kind::fu>>(params, error);
}

}  // namespace lodbench::tile_quadtree
