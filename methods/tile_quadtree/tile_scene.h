#pragma once
// The frozen selection on the GPU: one instanced draw call for the picture, one for the region.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/tile_streamer.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "tile_quadtree/readback.h"
#include "tile_quadtree/tile_catalogue.h"
#include "tile_quadtree/tile_cut.h"
#include "tile_quadtree/tile_mesh.h"

namespace lodbench::tile_quadtree {

enum class Cracks { snap, skirt, none };

class TileScene {
public:
    TileScene(Cracks cracks, int region_pixels) : cracks_(cracks), region_pixels_(region_pixels) {}

    /// Room for `most_tiles` drawn tiles.
    void upload(gl::Device& device, std::span<const gl::ShaderSource> shaders, int most_tiles);
    void release();

    /// What is drawn from now on; all of it is resident.
    void freeze(std::span<const DrawnTile> tiles, const TileCatalogue& catalogue,
                const common::TileStreamer& streamer);
    [[nodiscard]] int tile_count() const { return count_; }
    void draw(const common::TileStreamer& streamer);

    /// Draws where the ground lies that is frozen, as the camera of the block `Frozen` sees it, and
    /// asks for it.
    void ask_region(const common::TileStreamer& streamer);
    [[nodiscard]] bool region_pending() const { return region_readback_.pending(); }
    [[nodiscard]] bool region_arrived() const { return region_readback_.arrived(); }
    /// The bounding box of the visible ground, empty where none was seen; once. Waits.
    [[nodiscard]] SampleBox region(const TileCatalogue& catalogue);
    void forget_region() { region_readback_.forget(); }

private:
    /// As the vertex shader takes it.
    struct Instance {
        std::int32_t slot, level, row, column;
        std::int32_t coarser[4];
        std::int32_t coarsened;
        float foot;
    };
    static_assert(sizeof(Instance) == 40);

    Cracks cracks_;
    int region_pixels_;
    gl::Device* device_ = nullptr;
    gl::Program program_, region_program_;
    TileMesh mesh_;
    gl::Buffer indices_, instances_;
    gl::VertexArray vertices_;
    gl::Texture region_texture_;
    gl::Framebuffer region_framebuffer_;
    Readback region_readback_;
    int count_ = 0;
    std::vector<Instance> staged_;
    std::vector<glm::vec4> bounds_;
};

}  // namespace lodbench::tile_quadtree
