// hybrid-patches: F. Loeffler, S. Schwanke, H. Schumann, "A Hybrid Approach for High Quality
// Real-Time Terrain Rendering and Optimized A-Priori Error Estimation", 2010, section 4. Patches
// are selected by nested criteria, each is refined on the CPU into a strip, and the strip stays on
// the GPU while the viewpoint stays in its sphere of validity. What is CPU only lies in
// hybrid_frame.h; here strips are uploaded and drawn. Parameters and deviations: README.md.

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "gl/device.h"
#include "gl/objects.h"
#include "hybrid_patches/hybrid_frame.h"
#include "hybrid_patches/methods.h"
#include "hybrid_patches/patch_scene.h"

namespace lodbench::hybrid_patches {
namespace {

/// Commands of a frame in one of three buffers in turn, so that writing does not wait for the GPU.
class CommandRing {
public:
    void begin_frame(gl::Device& device, std::size_t commands) {
        current_ = (current_ + 1) % slots_.size();
        const std::size_t bytes = commands * sizeof(DrawCommand);
        if (slots_[current_].bytes() < bytes) {
            slots_[current_] = gl::Buffer(device, "hybrid-patches: commands", bytes + bytes / 2);
        }
    }
    void write(std::span<const DrawCommand> commands, std::size_t first) {
        if (!commands.empty()) slots_[current_].write(commands, first * sizeof(DrawCommand));
    }
    [[nodiscard]] const gl::Buffer& buffer() const { return slots_[current_]; }
    void release() { slots_ = {}; }

private:
    std::array<gl::Buffer, 3> slots_;
    std::size_t current_ = 0;
};

class HybridPatches final : public Method {
public:
    explicit HybridPatches(const Params& params)
        : scene_(params, "hybrid-patches"),
          cache_bytes_(std::size_t(params.integer("cache_mib")) << 20) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        scene_.prepare(terrain);
        const common::RefinerOptions& options = scene_.options();
        cache_.emplace(scene_.hierarchy().size(), cache_bytes_, options.metric);
        frame_.emplace(scene_.grid(), scene_.hierarchy(), *cache_, options.tau, options.metric,
                       options.culling);
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        scene_.upload(device);
        std::vector<PatchPlace> places;
        places.reserve(scene_.hierarchy().size());
        for (std::uint32_t i = 0; i < scene_.hierarchy().size(); ++i) {
            places.push_back(scene_.place(i));
        }
        places_ =
            gl::Buffer(device, "hybrid-patches: patches", std::span<const PatchPlace>(places));
        if (cache_bytes_ > 0) {
            cached_ = gl::Buffer(device, "hybrid-patches: cache", cache_bytes_);
            cached_vertices_ = scene_.vertex_array(device, places_, cached_);
        }
        streamed_ = gl::Buffer(device, "hybrid-patches: stream", kStreamBytes);
        streamed_vertices_ = scene_.vertex_array(device, places_, streamed_);
    }

    void select(const Camera& camera, const Clock&) override {
        frame_->begin(camera);
        commands_.clear();
        batches_.clear();
        pending_ = true;
        ring_.begin_frame(*device_, frame_->selected().size());
    }

    void settle() override { complete(); }

    /// At the first call after `select`, what holds is drawn while the rest is being refined.
    void draw(const View&) override {
        if (!pending_) {
            draw_cached(0, commands_.size());
            draw_streamed();
            return;
        }
        for (const SelectedPatch& patch : frame_->selected()) {
            if (patch.reused != nullptr) commands_.push_back(command(patch.patch, *patch.reused));
        }
        const std::size_t reused = commands_.size();
        ring_.write(commands_, 0);
        draw_cached(0, reused);
        complete();
        draw_cached(reused, commands_.size() - reused);
        draw_streamed();
    }

    [[nodiscard]] Counters counters() const override {
        return {{"patches_selected", double(frame_->selected().size())},
                {"patches_reused", double(frame_->selected().size() - frame_->refined())},
                {"patches_refined", double(frame_->refined())},
                {"patches_streamed", double(streamed_count_)},
                {"patches_evicted_so_far", double(cache_->evicted())},
                {"vertices_tested", double(tested_)},
                {"triangles_without_swaps", double(triangles_)},
                {"cache_bytes", double(cache_->used_bytes())},
                {"strip_bytes_uploaded", double(uploaded_)}};
    }

    void release(gl::Device&) override {
        frame_->finish();
        cached_vertices_ = {};
        streamed_vertices_ = {};
        cached_ = {};
        streamed_ = {};
        places_ = {};
        ring_.release();
        scene_.release();
    }

private:
    static constexpr std::size_t kStreamBytes = std::size_t(1) << 18;

    /// Strips that found no room in the cache and fit into the stream buffer together.
    struct Batch {
        std::size_t first_command = 0;
        std::vector<const Refinement*> refinements;
    };

    static DrawCommand command(std::uint32_t patch, const PatchCache::Entry& entry) {
        return {entry.index_count, 1, GLuint(entry.block.offset / sizeof(std::uint16_t)), 0, patch};
    }

    /// Waits for the refinements and finds places for them. Commands already there stay in front;
    /// without them, all come in the order of the hierarchy.
    void complete() {
        if (!pending_) return;
        frame_->finish();
        pending_ = false;
        const bool reused_are_there = !commands_.empty();
        const std::size_t first = commands_.size();
        tested_ = triangles_ = uploaded_ = 0;
        std::vector<const Refinement*> without_room;
        frame_->place_strips([&](const PlacedStrip& placed) {
            triangles_ += placed.triangles();
            if (placed.refinement == nullptr) {
                if (!reused_are_there) commands_.push_back(command(placed.patch, *placed.entry));
                return;
            }
            const Refinement& made = *placed.refinement;
            tested_ += made.tested;
            if (placed.entry == nullptr) {
                without_room.push_back(&made);
                return;
            }
            cached_.write(std::span<const std::uint16_t>(made.strip), placed.entry->block.offset);
            uploaded_ += made.strip.size() * sizeof(std::uint16_t);
            commands_.push_back(command(placed.patch, *placed.entry));
        });
        streamed_count_ = without_room.size();
        ring_.write(std::span<const DrawCommand>(commands_).subspan(first), first);
        make_batches(without_room);
    }

    void make_batches(const std::vector<const Refinement*>& without_room) {
        std::vector<DrawCommand> commands;
        std::size_t used = kStreamBytes;
        for (const Refinement* made : without_room) {
            const std::size_t bytes = made->strip.size() * sizeof(std::uint16_t);
            if (used + bytes > kStreamBytes) {
                used = 0;
                batches_.push_back({commands_.size() + commands.size(), {}});
            }
            batches_.back().refinements.push_back(made);
            commands.push_back({GLuint(made->strip.size()), 1, GLuint(used / sizeof(std::uint16_t)),
                                0, made->patch});
            used += bytes;
        }
        ring_.write(commands, commands_.size());
    }

    void draw_cached(std::size_t first, std::size_t count) {
        if (count == 0) return;
        device_->draw_elements_indirect(scene_.program(), cached_vertices_, GL_TRIANGLE_STRIP,
                                        GL_UNSIGNED_SHORT, ring_.buffer(),
                                        first * sizeof(DrawCommand), GLsizei(count));
    }

    void draw_streamed() {
        for (const Batch& batch : batches_) {
            std::size_t offset = 0;
            for (const Refinement* made : batch.refinements) {
                streamed_.write(std::span<const std::uint16_t>(made->strip), offset);
                offset += made->strip.size() * sizeof(std::uint16_t);
            }
            uploaded_ += offset;
            device_->draw_elements_indirect(scene_.program(), streamed_vertices_, GL_TRIANGLE_STRIP,
                                            GL_UNSIGNED_SHORT, ring_.buffer(),
                                            batch.first_command * sizeof(DrawCommand),
                                            GLsizei(batch.refinements.size()));
        }
    }

    PatchScene scene_;
    std::size_t cache_bytes_;
    std::optional<PatchCache> cache_;
    std::optional<HybridFrame> frame_;
    gl::Device* device_ = nullptr;
    gl::Buffer places_;  ///< of all patches
    gl::Buffer cached_, streamed_;
    gl::VertexArray cached_vertices_, streamed_vertices_;
    CommandRing ring_;
    bool pending_ = false;  ///< selected, but refinements have no places yet
    std::vector<DrawCommand> commands_;
    std::vector<Batch> batches_;
    std::size_t streamed_count_ = 0, tested_ = 0, triangles_ = 0, uploaded_ = 0;
};

}  // namespace

Method* create_hybrid_patches(const Params& params, CreateError* error) noexcept {
    return create_method<HybridPatches>(params, error);
}

}  // namespace lodbench::hybrid_patches
