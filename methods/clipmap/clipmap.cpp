// clipmap: nested square rings of one triangulation around the viewer, each of twice the spacing of
// the next finer one, over windows of a filtered pyramid that follow the viewer by wrapping around.
// A. Asirvatham, H. Hoppe: Terrain Rendering Using GPU-Based Geometry Clipmaps (2005), after F.
// Losasso, H. Hoppe: Geometry Clipmaps: Terrain Rendering Using Nested Regular Grids (2004).
// Deviations: see README.md.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/method.h"
#include "clipmap/height_levels.h"
#include "clipmap/rings.h"
#include "clipmap/tent_terrain.h"
#include "common/height_ranges.h"
#include "common/toroidal_window.h"
#include "common/view_frustum.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::clipmap {
namespace {

namespace block {
using glm::ivec4;
using glm::vec4;
#define BLOCK(binding_, name_) struct name_
#include "clipmap/clipmap_block.glsl"
#undef BLOCK
}  // namespace block
using block::ClipmapBlock;
constexpr GLuint kBlockBinding = gl::kFirstFreeBinding;  // CLIPMAP_BINDING of clipmap.vert
constexpr std::size_t kMostLevels = 32;
static_assert(offsetof(ClipmapBlock, viewers) == 16 * kMostLevels &&
              sizeof(ClipmapBlock) == 32 * kMostLevels);

// Losasso & Hoppe 2004, section 3: a level of a smaller extent, in heights of the viewer above the
// ground, is not worth drawing.
constexpr double kLeastExtent = 2.5;

struct Options {
    RingSize size;
    bool filtered, blend, closed, culling;
    std::int64_t texels_per_frame;
    int loader_threads, prefetch_frames;

    explicit Options(const Params& params)
        : size(int(params.integer("n"))),
          filtered(params.choice("filter") == "tent"),
          blend(params.boolean("blend")),
          closed(params.choice("borders") == "closed"),
          culling(params.boolean("culling")),
          texels_per_frame(params.integer("texels_per_frame")),
          loader_threads(int(params.integer("loader_threads"))),
          prefetch_frames(int(params.integer("prefetch"))) {}
};

/// Columns, rows and level of one instance of a piece's shape.
using Instance = glm::ivec3;

/// A shape's instances: one draw call.
struct Draw {
    int shape = 0;
    GLuint first = 0;
    GLsizei count = 0;
};

/// Two triangles a cell, cut from north-west to south-east, row by row.
std::vector<std::uint16_t> cell_indices(glm::ivec2 cells) {
    std::vector<std::uint16_t> indices;
    indices.reserve(6 * std::size_t(cells.x) * std::size_t(cells.y));
    for (int y = 0; y < cells.y; ++y) {
        for (int x = 0; x < cells.x; ++x) {
            const auto nw = std::uint16_t(y * (cells.x + 1) + x), ne = std::uint16_t(nw + 1);
            const auto sw = std::uint16_t(nw + cells.x + 1), se = std::uint16_t(sw + 1);
            indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
        }
    }
    return indices;
}

class Clipmap final : public Method {
public:
    explicit Clipmap(const Params& params) : options_(params) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        info_ = terrain.info();
        ranges_.emplace(terrain);
        levels_ = level_count(info_, options_.size);
        if (options_.filtered) tent_.emplace(terrain);
        heights_.emplace(options_.filtered ? static_cast<const Terrain&>(*tent_) : terrain,
                         HeightLevelsOptions{.levels = levels_,
                                             .filtered = options_.filtered,
                                             .resident_samples = options_.size.n(),
                                             .window_samples = options_.size.n(),
                                             .loader_threads = options_.loader_threads});
        windows_.assign(std::size_t(levels_), common::ToroidalWindow(options_.size.n()));
        texels_written_.assign(std::size_t(levels_), 0);
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        program_ = gl::Program(
            device, "clipmap", embedded_shaders(),
            {{GL_VERTEX_SHADER, "clipmap.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        const RingSize& size = options_.size;
        program_.set("side", size.n());
        program_.set("coarsest", levels_ - 1);
        program_.set("blends", options_.blend ? 1 : 0);
        program_.set("closes", options_.closed ? 1 : 0);
        program_.set("blend_begin", float(size.blend_begin()));
        program_.set("blend_width", float(size.blend_width()));
        texture_ = gl::Texture(device, "clipmap: heights", GL_TEXTURE_2D_ARRAY, GL_RG32F, size.n(),
                               size.n(), 1, levels_);
        block_buffer_ = gl::Buffer(device, "clipmap: squares", sizeof block_);
        shapes_ = piece_shapes(size);
        instances_buffer_ =
            gl::Buffer(device, "clipmap: pieces",
                       full_square(size).size() * std::size_t(levels_) * sizeof(Instance));
        for (const glm::ivec2& shape : shapes_) {
            const std::string name = fmt::format("clipmap: piece {}x{}", shape.x, shape.y);
            const auto indices = cell_indices(shape);
            indices_.emplace_back(device, name, std::span<const std::uint16_t>(indices));
            gl::VertexArray& vertices = vertex_arrays_.emplace_back(device, name);
            vertices.integer_attribute(0, 3, GL_INT, instances_buffer_, 0, sizeof(Instance), 1);
            vertices.elements(indices_.back());
        }
    }

    void select(const Camera& camera, const Clock&) override {
        const std::optional<glm::dvec2> before = viewer_;
        camera_ = camera;
        place_viewer();
        heights_->begin_frame();
        update_windows();
        if (!exact_) {
            if (heights_->missing_tiles() == 0 && before) prefetch(*viewer_ - *before);
            heights_->request_missing();
        }
        freeze();
    }

    /// From the first call on every `select` is exact: all levels that it asks for are there. What
    /// came before depends on the clock, and is forgotten.
    void settle() override {
        if (exact_) return;
        exact_ = true;
        heights_->wait_for_tiles();
        for (common::ToroidalWindow& window : windows_) window.forget();
        select(camera_, {});
    }

    void draw(const View&) override {
        if (draws_.empty()) return;
        block_buffer_.bind_uniform(kBlockBinding);
        texture_.bind(0);
        for (const Draw& draw : draws_) {
            const glm::ivec2 cells = shapes_[std::size_t(draw.shape)];
            program_.set("piece_columns", cells.x + 1);
            device_->draw_elements(program_, vertex_arrays_[std::size_t(draw.shape)], GL_TRIANGLES,
                                   6 * cells.x * cells.y, GL_UNSIGNED_SHORT, 0, draw.count, 0,
                                   draw.first);
        }
    }

    void pause_background() override { heights_->pause(); }
    void resume_background() override { heights_->resume(); }

    [[nodiscard]] Counters counters() const override {
        std::int64_t written = 0;
        for (const std::int64_t texels : texels_written_) written += texels;
        Counters counters = {{"n", double(options_.size.n())},
                             {"levels", double(levels_)},
                             {"levels_active", double(levels_ - finest_active_)},
                             {"levels_missing", double(finest_active_ - finest_wanted_)},
                             {"finest_level", double(finest_active_)},
                             {"height_above_ground_m", height_above_ground_},
                             {"pieces_drawn", double(instances_.size())},
                             {"pieces_in_all", double(pieces_in_all_)},
                             {"texels_written", double(written)},
                             {"tiles_missing", double(tiles_missing_)},
                             {"tiles_in_memory", double(heights_->tiles_in_memory())},
                             {"tiles_read_so_far", double(heights_->tiles_read())}};
        for (int level = 0; level < levels_; ++level) {
            counters.emplace_back(fmt::format("texels_written_level_{}", level),
                                  double(texels_written_[std::size_t(level)]));
        }
        return counters;
    }

    void release(gl::Device&) override {
        heights_.reset();  // its threads with it
        vertex_arrays_.clear();
        indices_.clear();
        instances_buffer_ = {};
        block_buffer_ = {};
        texture_ = {};
        program_ = {};
    }

private:
    /// Where the viewer is in the grid, and how many levels are worth drawing from there. Outside
    /// of the terrain the rings stand around the nearest place of its border, and the way from
    /// there counts as height does.
    void place_viewer() {
        const glm::dvec2 east_north = (glm::dvec2(camera_.position) - info_.origin) / info_.spacing;
        const glm::dvec2 place(east_north.x, info_.rows - 1 - east_north.y);
        viewer_ = glm::clamp(place, glm::dvec2(0), glm::dvec2(info_.columns - 1, info_.rows - 1));
        outside_ = glm::length((place - *viewer_) * info_.spacing);
    }

    [[nodiscard]] int finest_worth_drawing() const {
        const double extent = (options_.size.n() - 1) * std::max(info_.spacing.x, info_.spacing.y);
        const double least = kLeastExtent * std::max(height_above_ground_, outside_);
        int level = 0;
        while (level + 1 < levels_ && extent * double(std::int64_t(1) << level) < least) ++level;
        return level;
    }

    /// Coarse levels first. A level that is not complete is not active, nor is any finer one.
    void update_windows() {
        height_above_ground_ = camera_.position.z - heights_->ground_height(*viewer_);
        finest_wanted_ = finest_worth_drawing();
        finest_active_ = levels_;
        origins_ = ring_origins(*viewer_, options_.size, levels_);
        std::ranges::fill(texels_written_, 0);
        std::int64_t budget =
            exact_ ? std::numeric_limits<std::int64_t>::max() : options_.texels_per_frame;
        for (int level = levels_ - 1; level >= finest_wanted_; --level) {
            common::ToroidalWindow& window = windows_[std::size_t(level)];
            window.move_to(origins_[std::size_t(level)]);
            // The coarsest level waits for no disk and is not held back: there is always a surface.
            const bool always = level == levels_ - 1;
            std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();
            fill(level, window, always ? unlimited : budget);
            if (window.complete() && finest_active_ == level + 1) finest_active_ = level;
        }
        tiles_missing_ = heights_->missing_tiles();
    }

    /// As far as samples are in memory and the budget (texels) goes, which is lowered. What is left
    /// is asked for.
    void fill(int level, common::ToroidalWindow& window, std::int64_t& budget) {
        const std::int64_t side = window.samples();
        while (budget >= side) {
            const int lines = int(std::min(budget / side, side));
            const std::optional<common::LevelRect> strip = window.next_strip(lines);
            if (!strip || !require(level, *strip)) break;
            for (const common::WindowPiece& piece : window.pieces(*strip)) write(level, piece);
            window.fill(*strip);
            budget -= strip->area();
            texels_written_[std::size_t(level)] += strip->area();
        }
        if (!window.complete()) require_rest(level, window);
    }
    void require_rest(int level, common::ToroidalWindow window) {
        while (const std::optional<common::LevelRect> strip = window.next_strip()) {
            static_cast<void>(require(level, *strip));
            window.fill(*strip);
        }
    }

    /// The samples of the next coarser level between which those of a rectangle lie.
    static common::LevelRect coarser_around(const common::LevelRect& samples) {
        const glm::ivec2 last = samples.high - 1;
        return {{samples.low.x >> 1, samples.low.y >> 1},
                {((last.x + 1) >> 1) + 1, ((last.y + 1) >> 1) + 1}};
    }

    bool require(int level, const common::LevelRect& samples) {
        const bool fine = heights_->require(level, samples);
        if (level == levels_ - 1) return fine;
        return heights_->require(level + 1, coarser_around(samples)) && fine;
    }

    /// Each texel's own height, and that of the next coarser level's triangle below it: its sample,
    /// or the middle of two that an edge joins (where row and column are odd the cell's diagonal).
    void write(int level, const common::WindowPiece& piece) {
        const common::LevelRect& samples = piece.samples;
        const glm::ivec2 size = samples.size();
        heights_->copy(level, samples, fine_);
        texels_.resize(fine_.size());
        if (level == levels_ - 1) {
            std::ranges::transform(fine_, texels_.begin(),
                                   [](float height) { return glm::vec2(height); });
        } else {
            const common::LevelRect around = coarser_around(samples);
            heights_->copy(level + 1, around, coarse_);
            const auto coarse = [&](int x, int y) {
                return coarse_[std::size_t(y - around.low.y) * std::size_t(around.size().x) +
                               std::size_t(x - around.low.x)];
            };
            std::size_t i = 0;
            for (int y = samples.low.y; y < samples.high.y; ++y) {
                for (int x = samples.low.x; x < samples.high.x; ++x, ++i) {
                    const float north_west = coarse(x >> 1, y >> 1);
                    const float south_east = coarse((x + 1) >> 1, (y + 1) >> 1);
                    texels_[i] = {fine_[i], 0.5F * north_west + 0.5F * south_east};
                }
            }
        }
        texture_.write(0, piece.texel.x, piece.texel.y, size.x, size.y, GL_RG, GL_FLOAT,
                       texels_.data(), level);
    }

    /// What will be wanted if the viewer goes on like this (`step`: samples a frame) is read while
    /// nothing else is.
    void prefetch(const glm::dvec2& step) {
        if (options_.prefetch_frames == 0 || step == glm::dvec2(0)) return;
        const auto ahead = ring_origins(*viewer_ + double(options_.prefetch_frames) * step,
                                        options_.size, levels_);
        for (int level = levels_ - 1; level >= finest_active_; --level) {
            common::ToroidalWindow window = windows_[std::size_t(level)];
            window.move_to(ahead[std::size_t(level)]);
            require_rest(level, window);
        }
    }

    void freeze() {
        instances_.clear();
        draws_.clear();
        std::vector<std::vector<Instance>> by_shape(shapes_.size());
        const common::ViewFrustum frustum(camera_);
        pieces_in_all_ = 0;
        for (int level = finest_active_; level < levels_; ++level) {
            const glm::ivec2 origin = origins_[std::size_t(level)];
            const auto pieces =
                level == finest_active_
                    ? full_square(options_.size)
                    : ring(options_.size, origins_[std::size_t(level) - 1] / 2 - origin);
            pieces_in_all_ += pieces.size();
            for (const Piece& piece : pieces) {
                if (options_.culling && !may_see(frustum, level, origin, piece)) continue;
                const auto shape = std::ranges::find(shapes_, piece.cells) - shapes_.begin();
                by_shape[std::size_t(shape)].emplace_back(piece.corner, level);
            }
            const double step = double(std::int64_t(1) << level);
            block_.squares[level] =
                glm::ivec4(origin << level, windows_[std::size_t(level)].texel(origin));
            block_.viewers[level] =
                glm::vec4(glm::dvec4(*viewer_ / step - glm::dvec2(origin), 0, 0));
        }
        for (std::size_t shape = 0; shape < by_shape.size(); ++shape) {
            if (by_shape[shape].empty()) continue;
            draws_.push_back(
                {int(shape), GLuint(instances_.size()), GLsizei(by_shape[shape].size())});
            instances_.insert(instances_.end(), by_shape[shape].begin(), by_shape[shape].end());
        }
        if (draws_.empty()) return;
        instances_buffer_.write(std::span<const Instance>(instances_));
        block_buffer_.write(0, sizeof block_, &block_);
    }

    /// False outside of the terrain, where all is cut off, and outside of the view.
    [[nodiscard]] bool may_see(const common::ViewFrustum& frustum, int level, glm::ivec2 origin,
                               const Piece& piece) const {
        const glm::ivec2 low = (origin + piece.corner) << level;
        const glm::ivec2 high = (origin + piece.corner + piece.cells) << level;
        const glm::ivec2 last(info_.columns - 1, info_.rows - 1);
        if (high.x < 0 || high.y < 0 || low.x > last.x || low.y > last.y) return false;
        // The coarser level's samples around it, and what the filter made them of.
        const int margin = 4 << level;
        const glm::vec2 range = ranges_->within(low - margin, high + margin);
        const glm::ivec2 inside_low = glm::clamp(low, glm::ivec2(0), last);
        const glm::ivec2 inside_high = glm::clamp(high, glm::ivec2(0), last);
        const glm::dvec2 north_west = info_.position(inside_low.y, inside_low.x);
        const glm::dvec2 south_east = info_.position(inside_high.y, inside_high.x);
        return frustum.may_see(
            {{north_west.x, south_east.y, range.x}, {south_east.x, north_west.y, range.y}});
    }

    Options options_;
    TerrainInfo info_;
    std::optional<common::HeightRanges> ranges_;
    std::optional<TentTerrain> tent_;
    std::optional<HeightLevels> heights_;
    std::vector<common::ToroidalWindow> windows_;  ///< of each level, whatever is active
    int levels_ = 0;
    bool exact_ = false;

    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Texture texture_;  ///< a layer a level
    gl::Buffer block_buffer_, instances_buffer_;
    std::vector<glm::ivec2> shapes_;
    std::vector<gl::Buffer> indices_;  ///< one a shape
    std::vector<gl::VertexArray> vertex_arrays_;

    Camera camera_;
    std::optional<glm::dvec2> viewer_;  ///< place in the grid, x: column, y: row
    double outside_ = 0;                ///< metres from the viewer to the terrain, in plan
    double height_above_ground_ = 0;
    int finest_wanted_ = 0, finest_active_ = 0;
    std::vector<glm::ivec2> origins_;
    ClipmapBlock block_{};
    std::vector<Instance> instances_;
    std::vector<Draw> draws_;
    std::size_t pieces_in_all_ = 0, tiles_missing_ = 0;
    std::vector<std::int64_t> texels_written_;  ///< of each level in this frame
    std::vector<float> fine_, coarse_;          ///< of the strip that is being written
    std::vector<glm::vec2> texels_;
};

constexpr ParamSpec kParams[] = {
    integer_param("n", 255, RingSize::kLeast, RingSize::kMost,
                  "vertices along a ring's edge: 4 m - 1, others are lowered to the next of these; "
                  "the paper's are 2^k - 1"),
    choice_param("filter", "tent", "tent|none",
                 "coarser levels: means with weights [1 2 1]^2 / 16, or every second sample"),
    boolean_param("blend", true,
                  "towards a ring's border heights go over into the coarser level's"),
    choice_param("borders", "closed", "closed|open",
                 "closed: the vertices of a ring's border stand on the coarser level's; open: gaps "
                 "stay"),
    boolean_param("culling", true, "leaves out blocks outside the view frustum"),
    integer_param("texels_per_frame", 1 << 22, 1 << 10, 1 << 24,
                  "texels that are written in a frame at most, coarse levels first; without limit "
                  "in lockstep"),
    integer_param("loader_threads", 2, 1, 16, "threads that read tiles"),
    integer_param("prefetch", 8, 0, 600,
                  "frames ahead for which tiles are read, by the viewer's movement; 0: none")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "clipmap",
     .title = "Geometry clipmaps: nested rings around the viewer, heights in toroidal textures",
     .citation =
         "Arul Asirvatham, Hugues Hoppe (2005): Terrain Rendering Using GPU-Based Geometry "
         "Clipmaps; after Frank Losasso, Hugues Hoppe (2004): Geometry Clipmaps: Terrain Rendering "
         "Using Nested Regular Grids",
     .version = "1",
     .capabilities = kAsynchronous | kOutOfCore,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = "n",
     .claimed_bound = nullptr,
     .create = create_method<Clipmap>,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::clipmap

LODBENCH_PLUGIN(lodbench::clipmap::kMethods);
