#pragma once
// (10) and (12) on the GPU, from the heights of tiles that are resident. Yang et al. 2016, section
// 4.2: "the computation of error metric is only aimed at visible tile nodes".
//
// The midpoints of a tile are samples of its children. So what each resident tile contributes to
// its parent's error is computed once, when the parent is first asked about; a tile all of whose
// children are resident has the greatest of theirs. Others have no error here: their heights have
// not been read.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "common/tile_streamer.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "tile_quadtree/tile_catalogue.h"

namespace lodbench::tile_quadtree {

/// Slots of a tile's children in the pool, in the order of their codes.
struct ChildSlots {
    /// A child that does not exist. A pool has fewer slots.
    static constexpr int kNone = 4095;
    std::array<int, 4> slots{kNone, kNone, kNone, kNone};

    /// In two floats, exact since both are integers of 24 bits; the second is never 0.
    [[nodiscard]] std::array<float, 2> packed() const {
        return {float(slots[0] * 4096 + slots[1]), float(slots[2] * 4096 + slots[3] + 1)};
    }
};

class ResidentErrors {
public:
    /// Room for `slots` resident tiles.
    void upload(gl::Device& device, std::span<const gl::ShaderSource> shaders, int slots) {
        device_ = &device;
        program_ = gl::Program(device, "tile_quadtree: errors", shaders,
                               {{GL_COMPUTE_SHADER, "errors.comp"}});
        shares_ = gl::Texture(device, "tile_quadtree: errors of the pool", GL_TEXTURE_2D, GL_RG32F,
                              slots, 1);
        wanted_ =
            gl::Buffer(device, "tile_quadtree: slots to compute", std::size_t(slots) * sizeof(int));
        computed_.assign(std::size_t(slots), std::nullopt);
    }
    void release() { *this = ResidentErrors(); }

    /// Where the children of a tile lie, if all of them are resident; notes those whose shares are
    /// not known yet.
    [[nodiscard]] std::optional<ChildSlots> children(const TileCatalogue& catalogue,
                                                     const common::TileStreamer& streamer,
                                                     const TileId& tile) {
        if (tile.level == 0) return std::nullopt;
        ChildSlots found;
        bool all = true;
        catalogue.for_each_child(tile, [&](const TileId& child) {
            const std::optional<int> slot = streamer.slot(child);
            all = all && slot.has_value();
            const int quadrant = child.row % 2 * 2 + child.column % 2;
            if (slot) found.slots[std::size_t(quadrant)] = *slot;
        });
        if (!all) return std::nullopt;
        catalogue.for_each_child(tile, [&](const TileId& child) {
            const int slot = *streamer.slot(child);
            // A tile's heights never change: what was computed of it in this slot stays true.
            std::optional<std::size_t>& computed = computed_[std::size_t(slot)];
            if (computed == catalogue.index(child)) return;
            computed = catalogue.index(child);
            pending_.push_back(slot);
        });
        return found;
    }
    /// Computes what `children` has noted: a work group a tile.
    void compute(const common::TileStreamer& streamer) {
        if (pending_.empty()) return;
        wanted_.write(std::span<const int>(pending_));
        wanted_.bind_storage(2);
        streamer.heights().bind(0);
        glBindImageTexture(0, shares_.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32F);
        device_->dispatch_compute(program_, GLuint(pending_.size()), 1, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
        computed_count_ += pending_.size();
        pending_.clear();
    }

    /// A texel a slot: ErrorShare::error and ErrorShare::relief of the tile in it.
    [[nodiscard]] const gl::Texture& shares() const { return shares_; }
    /// Tiles of which a share was computed, since the beginning.
    [[nodiscard]] std::size_t computed_count() const { return computed_count_; }

private:
    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Texture shares_;
    gl::Buffer wanted_;
    std::vector<std::optional<std::size_t>> computed_;  ///< by slot: the tile whose share is there
    std::vector<int> pending_;                          ///< slots
    std::size_t computed_count_ = 0;
};

}  // namespace lodbench::tile_quadtree
