#pragma once
// The metric on the GPU: visible tiles packed into a texture, a decision a texel. Yang et al. 2016,
// sections 3.4 and 4.2.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gl/device.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "tile_quadtree/readback.h"
#include "tile_quadtree/tile_metric.h"

namespace lodbench::tile_quadtree {

class TileDecisions {
public:
    /// Texels a row: "every row contains 4096 texels".
    static constexpr int kRow = 4096;

    /// `shaders`: the room's. By a fragment pass, as in the paper, or by a compute pass.
    void upload(gl::Device& device, std::span<const gl::ShaderSource> shaders, MetricKind kind,
                bool by_compute) {
        device_ = &device;
        by_compute_ = by_compute;
        std::map<std::string, std::string> defines;
        if (kind == MetricKind::spheres) defines.emplace("NESTED_SPHERES", "1");
        program_ = by_compute ? gl::Program(device, "tile_quadtree: decisions", shaders,
                                            {{GL_COMPUTE_SHADER, "decide.comp"}}, defines)
                              : gl::Program(device, "tile_quadtree: decisions", shaders,
                                            {{GL_VERTEX_SHADER, "decide.vert"},
                                             {GL_FRAGMENT_SHADER, "decide.frag"}},
                                            defines);
        vertices_ = gl::VertexArray(device, "tile_quadtree: no attributes");
    }
    void release() { *this = TileDecisions(); }

    /// Asks for a decision on each tile, for the camera that the block `Frozen` describes. Tiles
    /// go into the textures row by row in their order. `scale` as for TileMetric::judge.
    void ask(const TileMetric& metric, double scale, std::vector<TileId> tiles) {
        asked_ = std::move(tiles);
        if (asked_.empty()) return;
        const int rows = int((asked_.size() + kRow - 1) / kRow);
        make_room(rows);
        const std::size_t texels = std::size_t(rows) * kRow;
        places_.resize(texels);
        summaries_.resize(texels);
        for (std::size_t i = 0; i < asked_.size(); ++i) {
            const TileId& tile = asked_[i];
            const int side = kTileCells << tile.level;
            places_[i] = {tile.level, tile.column * side, tile.row * side, 0};
            summaries_[i] = metric.packed(tile);
        }
        // The last row's rest: level 0, which never splits.
        std::fill(places_.begin() + std::ptrdiff_t(asked_.size()), places_.end(), glm::vec4(0));
        place_texture_.write(0, 0, 0, kRow, rows, GL_RGBA, GL_FLOAT, places_.data());
        summary_texture_.write(0, 0, 0, kRow, rows, GL_RGBA, GL_FLOAT, summaries_.data());
        place_texture_.bind(1);
        summary_texture_.bind(2);
        program_.set("scale", float(scale));
        if (by_compute_) {
            glBindImageTexture(0, decision_texture_.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R8UI);
            device_->dispatch_compute(program_, kRow / 64, GLuint(rows), 1);
            glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
        } else {
            const OffscreenPass pass(framebuffer_, kRow, rows, false);
            device_->draw_arrays(program_, vertices_, GL_TRIANGLES, 0, 3);
        }
        readback_.begin(*device_, "tile_quadtree: decisions", decision_texture_, kRow, rows,
                        GL_RED_INTEGER, GL_UNSIGNED_BYTE);
    }
    /// Whether answers are on their way, and whether `answers` would not wait.
    [[nodiscard]] bool pending() const { return !asked_.empty() && readback_.pending(); }
    [[nodiscard]] bool arrived() const { return pending() && readback_.arrived(); }

    /// The tiles that were asked about, and for each of them 1 where it splits and 0 where not;
    /// once. Waits.
    [[nodiscard]] std::pair<std::vector<TileId>, std::vector<std::uint8_t>> answers() {
        std::vector<std::uint8_t> decisions;
        if (pending()) {
            decisions.resize((asked_.size() + kRow - 1) / kRow * kRow);
            readback_.read(decisions.data());
            decisions.resize(asked_.size());
        }
        return {std::exchange(asked_, {}), std::move(decisions)};
    }
    void forget() {
        asked_.clear();
        readback_.forget();
    }

private:
    void make_room(int rows) {
        if (place_texture_ && place_texture_.height() >= rows) return;
        int height = 1;
        while (height < rows) height *= 2;
        const auto texture = [&](const char* label, GLenum format) {
            return gl::Texture(*device_, label, GL_TEXTURE_2D, format, kRow, height);
        };
        place_texture_ = texture("tile_quadtree: visible tiles", GL_RGBA32F);
        summary_texture_ = texture("tile_quadtree: their summaries", GL_RGBA32F);
        decision_texture_ = texture("tile_quadtree: their decisions", GL_R8UI);
        framebuffer_ =
            gl::Framebuffer(*device_, "tile_quadtree: decisions", &decision_texture_, nullptr);
    }

    gl::Device* device_ = nullptr;
    bool by_compute_ = false;
    gl::Program program_;
    gl::VertexArray vertices_;
    gl::Texture place_texture_, summary_texture_, decision_texture_;
    gl::Framebuffer framebuffer_;
    Readback readback_;
    std::vector<TileId> asked_;
    std::vector<glm::vec4> places_, summaries_;
};

}  // namespace lodbench::tile_quadtree
