#pragma once
// The colour map on the GPU, in core, laid out as the fragment's fetches need it.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "gl/device.h"
#include "gl/objects.h"
#include "persistent_grid/colour_pyramid.h"
#include "persistent_grid/pyramid.h"

namespace lodbench::persistent_grid {

/// PGM_FETCHES of levels.glsl.
enum class Fetches { shared, colour_a_level, two, one, one_of_16_bits };

class ColourMap {
public:
    static constexpr GLuint kFirstUnit = 16;  ///< binding of the samplers in pgm.frag

    /// Reads the whole terrain. `fetches` is not `shared`.
    ColourMap(const Terrain& terrain, Fetches fetches) : info_(terrain.info()), fetches_(fetches) {
        Level finest{info_.columns, info_.rows, {}};
        finest.heights.resize(std::size_t(info_.columns) * std::size_t(info_.rows));
        terrain.read({0, 0, info_.rows, info_.columns}, finest.heights);
        levels_ = make_pyramid(hillshade(finest, info_));
    }
    void upload(gl::Device& device) {
        if (fetches_ == Fetches::colour_a_level) {
            for (const ColourLevel& level : levels_) {
                gl::Texture& texture = textures_.emplace_back(device, "pgm: colours", GL_TEXTURE_2D,
                                                              GL_RGBA8, level.columns, level.rows);
                texture.write(0, 0, 0, level.columns, level.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                              level.colours.data());
            }
        } else {
            upload_cells(device);
        }
        levels_ = {};  // the textures hold them from here on
    }
    void bind() const {
        for (std::size_t i = 0; i < textures_.size(); ++i) {
            textures_[i].bind(kFirstUnit + GLuint(i));
        }
    }
    void release() { textures_.clear(); }

private:
    void upload_cells(gl::Device& device) {
        const AtlasLayout layout = whole_layout(info_);
        gl::Texture& texture =
            textures_.emplace_back(device, "pgm: cells of colours", GL_TEXTURE_2D, GL_RGBA32UI,
                                   layout.size.x, layout.size.y);
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            const ColourLevel& level = levels_[i];
            const ColourLevel& parent = levels_[std::min(i + 1, levels_.size() - 1)];
            const std::vector<Cell> cells = fetches_ == Fetches::one_of_16_bits
                                                ? colour_cells_with_parent(level, parent)
                                                : colour_cells(level);
            texture.write(0, layout.origins[i].x, layout.origins[i].y, level.columns, level.rows,
                          GL_RGBA_INTEGER, GL_UNSIGNED_INT, cells.data());
        }
    }

    TerrainInfo info_;
    Fetches fetches_;
    std::vector<ColourLevel> levels_;  ///< until `upload`
    std::vector<gl::Texture> textures_;
};

}  // namespace lodbench::persistent_grid
