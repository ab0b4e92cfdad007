// multi-context: blocks of one shared mesh, selected by screen-space errors that another thread
// computes on a context of its own. Mohammad A. Yusuf, Mostafa G. M. Mostafa, Taha I. Elarif: A
// Multi-threaded Multi-context GPU Methodology for Real-time Terrain Rendering (2014). Deviations:
// see README.md.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "api/method.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "multi_context/block_mesh.h"
#include "multi_context/block_tree.h"
#include "multi_context/errors_activity.h"

namespace lodbench::multi_context {
namespace {

ReadBack read_back_from(const std::string& choice) {
    if (choice == "whole") return ReadBack::whole;
    return choice == "blocks" ? ReadBack::blocks : ReadBack::tree;
}

bool same(const Camera& a, const Camera& b) {
    return a.position == b.position && a.orientation == b.orientation &&
           a.vertical_fov == b.vertical_fov && a.viewport == b.viewport &&
           a.near_plane == b.near_plane;
}

class MultiContext final : public Method {
public:
    explicit MultiContext(const Params& params)
        : delta_(float(params.real("delta"))),
          asynchronous_(params.boolean("async")),
          batch_(params.boolean("batch")),
          skirts_(params.choice("cracks") == "skirt"),
          errors_settings_{.k = std::stoi(params.choice("k")),
                           .delta = delta_,
                           .bytes = params.choice("errors") == "byte",
                           .read_back = read_back_from(params.choice("readback")),
                           .parts = int(params.integer("spread"))} {
        if (errors_settings_.read_back == ReadBack::tree && errors_settings_.parts > 1) {
            throw InputError(
                "spread > 1 and readback = \"tree\" exclude each other: a tree comes back as far "
                "as "
                "it is split; use readback = \"whole\" or \"blocks\", or leave spread at 1");
        }
    }

    void prepare(const Terrain& terrain, gl::Device& device) override {
        terrain_ = &terrain;
        const TerrainInfo& info = terrain.info();
        layout_ = Layout(info.rows, info.columns, errors_settings_.k);
        const int limit = device.info().max_texture_size;
        if (layout_.samples() > limit) {
            throw EnvironmentError(fmt::format(
                "multi-context holds the whole terrain in one texture: {} x {} samples, padded to "
                "{} x {}, are more than the {} x {} that this driver allows; use a smaller terrain",
                info.columns, info.rows, layout_.samples(), layout_.samples(), limit, limit));
        }
        heights_ = gl::Texture(device, "multi-context: heights", GL_TEXTURE_2D, GL_R32F,
                               info.columns, info.rows);
        ranges_ = HeightRanges(terrain, layout_,
                               [this](const SampleRect& rect, std::span<const float> heights) {
                                   heights_.write(0, 0, rect.row, rect.columns, rect.rows, GL_RED,
                                                  GL_FLOAT, heights.data());
                               });
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        std::map<std::string, std::string> defines;
        if (batch_) defines["MULTI_CONTEXT_BATCH"] = "1";
        program_ = gl::Program(
            device, "multi-context", embedded_shaders(),
            {{GL_VERTEX_SHADER, "blocks.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}},
            defines);
        const BlockMesh mesh = make_block_mesh(layout_.k(), skirts_);
        index_count_ = GLsizei(mesh.indices.size());
        mesh_vertices_ = gl::Buffer(device, "multi-context: block vertices",
                                    std::span<const glm::vec3>(mesh.vertices));
        mesh_indices_ = gl::Buffer(device, "multi-context: block indices",
                                   std::span<const std::uint32_t>(mesh.indices));
        vertices_ = gl::VertexArray(device, "multi-context: block");
        vertices_.attribute(0, 3, mesh_vertices_, 0, sizeof(glm::vec3));
        vertices_.elements(mesh_indices_);
        if (batch_) {
            instances_ = gl::Buffer(device, "multi-context: selected blocks",
                                    ranges_.finest_count() * sizeof(glm::ivec4));
            vertices_.integer_attribute(1, 4, GL_INT, instances_, 0, sizeof(glm::ivec4), 1);
        }
        // The other context reads the heights: what wrote them is finished before its thread
        // starts.
        gl::Fence(device).wait();
        activity_.emplace(device, heights_, terrain_->info(), errors_settings_);
    }

    void select(const Camera& camera, const Clock& clock) override {
        Background<Camera, BlockErrors>& background = activity_->background();
        camera_ = camera;
        // A moment that is selected again was a warm-up: no time passed, so none was lost.
        if (asked_ > 0 && !settled_ && clock.frame != frame_) count_unsettled();
        frame_ = clock.frame;
        background.tick();
        // "As the viewpoint changes": errors depend on the camera and on delta, which is fixed.
        if (asked_ == 0 || !same(camera, asked_for_)) {
            asked_ = background.ask(camera);
            asked_for_ = camera;
        }
        settled_ = !asynchronous_;
        if (taken_ == 0 || !asynchronous_) background.wait_for(asked_);
        choose();
    }

    void settle() override {
        if (settled_) return;
        activity_->background().wait_for(asked_);
        settled_ = true;
        choose();
    }

    void draw(const View&) override {
        if (instances_of_.empty()) return;
        heights_.bind(0);
        if (batch_) {
            device_->draw_elements(program_, vertices_, GL_TRIANGLES, index_count_, GL_UNSIGNED_INT,
                                   0, GLsizei(instances_of_.size()));
            return;
        }
        for (const glm::ivec4& block : instances_of_) {
            program_.set("block", block);
            device_->draw_elements(program_, vertices_, GL_TRIANGLES, index_count_,
                                   GL_UNSIGNED_INT);
        }
    }

    void pause_background() override { activity_->background().pause(); }
    void resume_background() override { activity_->background().resume(); }

    [[nodiscard]] Counters counters() const override {
        const auto statistics = activity_->background().statistics();
        return {{"blocks_drawn", double(selection_.blocks.size())},
                {"blocks_culled", double(selection_.culled)},
                {"staleness_frames", double(asked_ - taken_)},
                {"staleness_frames_unsettled_mean_so_far",
                 unsettled_ > 0 ? double(unsettled_sum_) / double(unsettled_) : 0.0},
                {"staleness_frames_unsettled_max_so_far", double(unsettled_most_)},
                {"errors_pass_ms", 1e3 * statistics.work_s},
                {"errors_passes_per_second", statistics.per_second},
                {"errors_passes_so_far", double(statistics.done)},
                {"readback_bytes", double(activity_->background().result().read_back_bytes)},
                {"geometry_bytes", double(mesh_vertices_.bytes() + mesh_indices_.bytes())}};
    }

    void release(gl::Device&) override {
        activity_.reset();  // first: its thread reads the heights
        vertices_ = {};
        instances_ = {};
        mesh_indices_ = {};
        mesh_vertices_ = {};
        program_ = {};
        heights_ = {};
    }

private:
    /// The selection from the newest errors, for the camera of the last `select`; frozen until the
    /// next one (or its `settle`), since only `take` changes what `result` gives.
    void choose() {
        taken_ = activity_->background().take();
        const Traversal traversal(terrain_->info(), layout_, ranges_,
                                  activity_->background().result(), delta_, camera_);
        traversal.select(selection_);
        instances_of_.clear();
        // The coarsest cell that may lie across an edge: no block that is smaller than it bounds
        // how low its edge runs.
        int coarsest = 0;
        for (const SelectedBlock& block : selection_.blocks)
            coarsest = std::max(coarsest, block.lod);
        for (const SelectedBlock& block : selection_.blocks) {
            const int cells = layout_.block_cells() << block.lod;
            int above = 0;  // levels up to the ancestor that holds that cell's edge
            while (cells << above < 1 << coarsest) ++above;
            const float floor =
                ranges_.at(block.lod + above, block.row >> above, block.column >> above).low;
            instances_of_.emplace_back(block.column * cells, block.row * cells, block.lod,
                                       std::bit_cast<std::int32_t>(floor));
        }
        if (batch_) instances_.write(std::span<const glm::ivec4>(instances_of_));
    }

    /// The last selection was drawn as it was: nobody waited for its errors.
    void count_unsettled() {
        const std::uint64_t staleness = asked_ - taken_;
        ++unsettled_;
        unsettled_sum_ += staleness;
        unsettled_most_ = std::max(unsettled_most_, staleness);
    }

    float delta_;
    bool asynchronous_, batch_, skirts_;
    ErrorsSettings errors_settings_;
    const Terrain* terrain_ = nullptr;
    gl::Device* device_ = nullptr;
    Layout layout_;
    HeightRanges ranges_;
    gl::Texture heights_;
    gl::Program program_;
    gl::Buffer mesh_vertices_, mesh_indices_, instances_;
    gl::VertexArray vertices_;
    GLsizei index_count_ = 0;
    Camera camera_;
    Camera asked_for_;        ///< of the request `asked_`
    std::int64_t frame_ = 0;  ///< of the last selection
    Selection selection_;
    std::vector<glm::ivec4> instances_of_;  ///< what blocks.vert calls `block`, one a block
    std::uint64_t asked_ = 0;               ///< number of the errors that `camera_` needs
    std::uint64_t taken_ = 0;               ///< of those that the selection was made with
    bool settled_ = true;                   ///< nothing to wait for
    std::uint64_t unsettled_ = 0, unsettled_sum_ = 0, unsettled_most_ = 0;
    std::optional<ErrorsActivity> activity_;  // last: its thread reads the heights
};

constexpr ParamSpec kParams[] = {
    real_param("delta", 1, 0.01, 1000, "screen-space error above which a block is split, pixels"),
    choice_param("k", "33", "17|33|65", "vertices along a block's edge"),
    boolean_param("async", true,
                  "draws with the newest errors there are, as in the paper; false: waits for this "
                  "frame's errors"),
    choice_param("readback", "whole", "whole|blocks|tree",
                 "what comes back from the GPU: the paper's whole errors texture, each block's "
                 "greatest error, or those from the root down only where a block is split"),
    integer_param("spread", 1, 1, 64,
                  "frames over which a read-back is spread, as the paper proposes; with whole and "
                  "blocks"),
    choice_param("errors", "float", "float|byte",
                 "texels of the errors texture; byte, proposed by the paper, rounds up"),
    boolean_param("batch", false, "one instanced draw call instead of the paper's one a block"),
    choice_param("cracks", "none", "none|skirt",
                 "between blocks of different LOD: left open as in the paper, or hidden by "
                 "upright skirts")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "multi-context",
     .title = "Yusuf et al.: blocks of one mesh, by errors that a second context computes",
     .citation = "Mohammad A. Yusuf, Mostafa G. M. Mostafa, Taha I. Elarif (2014): A "
                 "Multi-threaded Multi-context GPU Methodology for Real-time Terrain Rendering",
     .version = "2",
     .capabilities = kAsynchronous | kSkirts,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = "delta",
     .claimed_bound = "delta",
     .create = create_method<MultiContext>,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::multi_context

LODBENCH_PLUGIN(lodbench::multi_context::kMethods);
