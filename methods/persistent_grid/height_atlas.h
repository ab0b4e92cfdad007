#pragma once
// The texture that holds what is there of the pyramid: all of it, or clip windows.

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "api/method.h"
#include "gl/device.h"
#include "gl/objects.h"
#include "persistent_grid/clip_windows.h"
#include "persistent_grid/colour_pyramid.h"
#include "persistent_grid/mapping_block.h"
#include "persistent_grid/mean_pyramid.h"
#include "persistent_grid/pyramid.h"

namespace lodbench::persistent_grid {

class HeightAtlas {
public:
    HeightAtlas() = default;
    virtual ~HeightAtlas() = default;
    HeightAtlas(const HeightAtlas&) = delete;
    HeightAtlas& operator=(const HeightAtlas&) = delete;

    virtual void upload(gl::Device& device) = 0;
    /// To the units from 0 up.
    void bind() const {
        for (std::size_t i = 0; i < textures_.size(); ++i) textures_[i].bind(GLuint(i));
    }
    void release() { textures_.clear(); }
    /// Follows the viewpoint, at a place in samples (x: columns, y: rows). `wait`: until all is
    /// there.
    virtual void follow(const glm::dvec2& /*place*/, bool /*wait*/) {}
    /// Writes `atlas` and `windows`: where the levels lie, and what is there of them.
    virtual void describe(MappingBlock& block) const = 0;
    virtual void pause() {}
    virtual void resume() {}
    virtual void add_counters(Counters& /*counters*/) const {}

protected:
    gl::Texture& add_texture(gl::Device& device, GLenum format, glm::ivec2 size) {
        return textures_.emplace_back(device, "pgm: heights", GL_TEXTURE_2D, format, size.x,
                                      size.y);
    }
    void write(glm::ivec2 texel, glm::ivec2 size, const float* heights) {
        textures_.front().write(0, texel.x, texel.y, size.x, size.y, GL_RED, GL_FLOAT, heights);
    }

private:
    std::vector<gl::Texture> textures_;
};

/// PGM_HEIGHTS of levels.glsl.
enum class HeightLayout { floats, packed, texture_a_level };

/// In core: all levels whole.
class WholeAtlas final : public HeightAtlas {
public:
    WholeAtlas(const Terrain& terrain, HeightLayout heights)
        : info_(terrain.info()), heights_(heights) {
        Level finest{info_.columns, info_.rows, {}};
        finest.heights.resize(std::size_t(info_.columns) * std::size_t(info_.rows));
        terrain.read({0, 0, info_.rows, info_.columns}, finest.heights);
        levels_ = make_pyramid(std::move(finest));
    }
    void upload(gl::Device& device) override {
        switch (heights_) {
            case HeightLayout::floats: upload_floats(device); break;
            case HeightLayout::packed: upload_cells(device); break;
            case HeightLayout::texture_a_level: upload_levels(device); break;
        }
        levels_ = {};  // the textures hold them from here on
    }
    void describe(MappingBlock& block) const override {
        const AtlasLayout layout = whole_layout(info_);
        for (int level = 0; level < level_count(info_); ++level) {
            block.atlas[level] = {layout.origins[std::size_t(level)], -1, -1};
            block.windows[level] = {0, 0, level_size(info_, level) - 1};
        }
        const HeightPacking packing(info_);
        block.packing = {packing.lowest, packing.quantum, 0, 0};
    }

private:
    void upload_floats(gl::Device& device) {
        const AtlasLayout layout = whole_layout(info_);
        add_texture(device, GL_R32F, layout.size);
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            write(layout.origins[i], {levels_[i].columns, levels_[i].rows},
                  levels_[i].heights.data());
        }
    }
    void upload_cells(gl::Device& device) {
        const AtlasLayout layout = whole_layout(info_);
        gl::Texture& texture = add_texture(device, GL_RGBA32UI, layout.size);
        const HeightPacking packing(info_);
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            const Level& parent = levels_[std::min(i + 1, levels_.size() - 1)];
            texture.write(0, layout.origins[i].x, layout.origins[i].y, levels_[i].columns,
                          levels_[i].rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                          height_cells(levels_[i], parent, packing).data());
        }
    }
    void upload_levels(gl::Device& device) {
        for (const Level& level : levels_) {
            add_texture(device, GL_R32F, {level.columns, level.rows})
                .write(0, 0, 0, level.columns, level.rows, GL_RED, GL_FLOAT, level.heights.data());
        }
    }

    TerrainInfo info_;
    HeightLayout heights_;
    std::vector<Level> levels_;  ///< until `upload`
};

/// Out of core: clip windows, filled from the pyramid's file.
class ClipAtlas final : public HeightAtlas {
public:
    /// Without `cache` the pyramid is made anew.
    ClipAtlas(const Terrain& terrain, const ClipOptions& options, bool cache)
        : options_(options),
          pyramid_(terrain, cache ? cache_folders() : std::vector<std::filesystem::path>{}),
          windows_(pyramid_, options) {}

    void upload(gl::Device& device) override {
        add_texture(device, GL_R32F, windows_.texture_size());
        windows_.start(writer());
    }
    void follow(const glm::dvec2& place, bool wait) override {
        if (wait) {
            windows_.load(place, writer());
        } else {
            windows_.update(place, writer());
        }
    }
    void describe(MappingBlock& block) const override {
        for (int level = 0; level < windows_.level_count(); ++level) {
            block.atlas[level] = {windows_.corner(level), glm::ivec2(options_.texels - 1)};
            // The last texels, inclusive: nothing is held where they are below the first.
            block.windows[level] = {windows_.held(level).low, windows_.held(level).high - 1};
        }
    }
    void pause() override { windows_.pause(); }
    void resume() override { windows_.resume(); }
    void add_counters(Counters& counters) const override {
        const ClipCounts& counts = windows_.counts();
        counters.insert(counters.end(), {{"pyramid_was_cached", pyramid_.was_cached() ? 1.0 : 0.0},
                                         {"pyramid_file_bytes", double(pyramid_.file_bytes())},
                                         {"window_texels_written", double(counts.texels)},
                                         {"window_lines_written", double(counts.lines)},
                                         {"window_texels_missing", double(counts.missing)},
                                         {"windows_behind", double(counts.windows_behind)},
                                         {"window_update_ms", 1e3 * counts.seconds},
                                         {"window_upload_ms", 1e3 * counts.writing_s}});
    }

private:
    [[nodiscard]] ClipWindows::Write writer() {
        return [this](glm::ivec2 texel, glm::ivec2 size, std::span<const float> heights) {
            write(texel, size, heights.data());
        };
    }

    ClipOptions options_;
    MeanPyramid pyramid_;
    ClipWindows windows_;
};

}  // namespace lodbench::persistent_grid
