#pragma once
// The metric on the GPU: visible tiles packed into a texture, a decision a texel. Yang et al. 2016,
// sections 3.4 and 4.2.

#include <algorithm>
#include <cstdint>
#include <map>
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
    /// `resident_errors`: summaries may hold ChildSlots, and ResidentErrors::shares is bound at
    /// texture unit 3 whenever tiles are asked about.
    void upload(gl::Device& device, std::span<const gl::ShaderSource> shaders,
                const MetricOptions& metric, bool by_compute, bool resident_errors) {
        device_ = &device;
        by_compute_ = by_compute;
        std::map<std::string, std::string> defines;
        if (metric.volume == Volume::sphere) defines.emplace("NESTED_SPHERES", "1");
        if (resident_errors) defines.emplace("RESIDENT_ERRORS", "1");
        if (metric.shared == SharedHeight::triangle) defines.emplace("SHARED_WITH_TRIANGLE", "1");
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
    /// go into the textures row by row in their order, and only they are sent. `scale` as for
    /// TileMetric::judge; `summaries[i]` is TileMetric::packed of `tiles[i]`, or has ChildSlots in
    /// place of error and 0.
    void ask(double scale, std::vector<TileId> tiles, std::span<const glm::vec4> summaries) {
        asked_ = std::move(tiles);
        if (asked_.empty()) return;
        const int rows = int((asked_.size() + kRow - 1) / kRow);
        make_room(rows);
        places_.clear();
        for (const TileId& tile : asked_) {
            const int side = kTileCells << tile.level;
            places_.emplace_back(tile.level, tile.column * side, tile.row * side, 0);
        }
        write(place_texture_, places_);
        write(summary_texture_, summaries);
        place_texture_.bind(1);
        summary_texture_.bind(2);
        program_.set("scale", float(scale));
        program_.set("tile_count", int(asked_.size()));
        if (by_compute_) {
            glBindImageTexture(0, decision_texture_.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R8UI);
            device_->dispatch_compute(program_, GLuint(width() + 63) / 64, GLuint(rows), 1);
            glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
        } else {
            const OffscreenPass pass(framebuffer_, width(), rows, false);
            device_->draw_arrays(program_, vertices_, GL_TRIANGLES, 0, 3);
        }
        readback_.begin(*device_, "tile_quadtree: decisions", decision_texture_, width(), rows,
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
            const std::size_t rows = (asked_.size() + kRow - 1) / kRow;
            decisions.resize(rows * std::size_t(width()));
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
    /// Texels of a row that are decided on: of a single row those in use, in whole words of four.
    [[nodiscard]] int width() const {
        return int(std::min(std::size_t(kRow), (asked_.size() + 3) / 4 * 4));
    }
    static void write(gl::Texture& texture, std::span<const glm::vec4> texels) {
        const int whole_rows = int(texels.size() / kRow), rest = int(texels.size() % kRow);
        if (whole_rows > 0) {
            texture.write(0, 0, 0, kRow, whole_rows, GL_RGBA, GL_FLOAT, texels.data());
        }
        if (rest > 0) {
            texture.write(0, 0, whole_rows, rest, 1, GL_RGBA, GL_FLOAT,
                          texels.last(std::size_t(rest)).data());
        }
    }
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
    std::vector<glm::vec4> places_;
};

}  // namespace lodbench::tile_quadtree
