// pgm: a grid over the screen, mapped by the vertex shader onto the terrain; no tree, no error
// metric. Yotam Livny, Neta Sokolovsky, Tal Grinshpoun, Jihad El-Sana: Persistent Grid Mapping: A
// GPU-based Framework for Interactive Terrain Rendering (2006). Deviations: see README.md.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "api/method.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "persistent_grid/colour_map.h"
#include "persistent_grid/height_atlas.h"
#include "persistent_grid/mapping.h"
#include "persistent_grid/pyramid.h"

namespace lodbench::persistent_grid {
namespace {

/// Two triangles a cell, in bands of eight columns from the horizon downward, so that a vertex is
/// reused while it is still in the vertex cache. Neighbours share vertices by index, hence to the
/// bit.
std::vector<std::uint32_t> grid_indices(const GridSize& grid) {
    constexpr int kBand = 8;
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * std::size_t(grid.columns - 1) * std::size_t(grid.rows - 1));
    for (int band = 0; band < grid.columns - 1; band += kBand) {
        const int end = std::min(band + kBand, grid.columns - 1);
        for (int row = 0; row < grid.rows - 1; ++row) {
            for (int column = band; column < end; ++column) {
                const auto far_left = std::uint32_t(row * grid.columns + column);
                const auto near_left = far_left + std::uint32_t(grid.columns);
                indices.insert(indices.end(), {far_left, near_left, near_left + 1, far_left,
                                               near_left + 1, far_left + 1});
            }
        }
    }
    return indices;
}

/// PGM_LEVEL of pgm.vert.
std::string level_rule(const Params& params) {
    if (params.boolean("finest_only")) return "PGM_FINEST_ONLY";
    if (params.choice("level") == "distance") return "PGM_BY_DISTANCE";
    return params.choice("spacing") == "formula" ? "PGM_BY_FORMULA" : "PGM_BY_NEIGHBOUR";
}

GridSize grid_size(const Params& params) {
    constexpr double kMaximumVertices = 1 << 26;  // 1.6 GB of indices
    const int rows = int(params.integer("grid"));
    const double columns = std::max(2.0, std::round(rows * params.real("aspect")));
    if (columns * rows > kMaximumVertices) {
        throw InputError(
            fmt::format("grid = {} with aspect = {} makes {} vertices, more than {}; lower one",
                        rows, params.real("aspect"), columns * rows, kMaximumVertices));
    }
    const bool denser_at_horizon = params.choice("rows") == "horizon";
    if (denser_at_horizon && level_rule(params) == "PGM_BY_FORMULA") {
        throw InputError(
            "spacing = \"formula\" does not go with rows = \"horizon\": equation (3) has one angle "
            "between all rows; choose spacing = \"neighbour\"");
    }
    return {int(columns), rows, denser_at_horizon};
}

/// PGM_INTERPOLATION of pgm.vert.
std::string interpolation_rule(const Params& params) {
    const std::string& name = params.choice("interpolation");
    if (name == "nearest") return "PGM_NEAREST";
    return name == "bilinear" ? "PGM_BILINEAR" : "PGM_PARENT";
}

ClipOptions clip_options(const Params& params) {
    const int texels = int(params.integer("window"));
    if (!std::has_single_bit(unsigned(texels))) {
        throw InputError(
            fmt::format("window = {} is not a power of two; write 64, 128 ... 2048", texels));
    }
    return {.texels = texels,
            .lines_per_frame = int(params.integer("lines_per_frame")),
            .entire = params.choice("update") == "entire",
            .loader_threads = int(params.integer("loader_threads"))};
}

Fetches fetches(const Params& params) {
    const std::string& name = params.choice("fetches");
    if (name == "shared") return Fetches::shared;
    if (name == "multi-texture") return Fetches::colour_a_level;
    if (name == "2") return Fetches::two;
    return name == "1-with-parent" ? Fetches::one_of_16_bits : Fetches::one;
}
const char* name_in_shader(Fetches fetches) {
    switch (fetches) {
        case Fetches::shared: return "PGM_SHARED";
        case Fetches::colour_a_level: return "PGM_COLOUR_A_LEVEL";
        case Fetches::two: return "PGM_TWO_FETCHES";
        case Fetches::one: return "PGM_ONE_FETCH";
        case Fetches::one_of_16_bits: return "PGM_ONE_FETCH_16_BITS";
    }
    throw ContractError("pgm: a number of fetches that does not exist");
}

HeightLayout height_layout(const Params& params) {
    const bool a_level = params.choice("fetches") == "multi-texture";
    if (!params.boolean("packing")) {
        return a_level ? HeightLayout::texture_a_level : HeightLayout::floats;
    }
    if (a_level || params.choice("interpolation") != "parent") {
        throw InputError(
            "packing = true holds four heights and their parents' in one texel; choose "
            "interpolation = \"parent\" and fetches other than \"multi-texture\"");
    }
    return HeightLayout::packed;
}
const char* name_in_shader(HeightLayout heights) {
    switch (heights) {
        case HeightLayout::floats: return "PGM_FLOATS";
        case HeightLayout::packed: return "PGM_PACKED";
        case HeightLayout::texture_a_level: return "PGM_TEXTURE_A_LEVEL";
    }
    throw ContractError("pgm: a layout of heights that does not exist");
}

enum class Storage { automatic, whole, windows };
Storage storage(const Params& params) {
    const std::string& name = params.choice("storage");
    if (name == "auto") return Storage::automatic;
    return name == "whole" ? Storage::whole : Storage::windows;
}

class PersistentGrid final : public Method {
public:
    explicit PersistentGrid(const Params& params)
        : grid_(grid_size(params)),
          coverage_{params.real("margin"), params.boolean("extend")},
          base_near_ground_(params.choice("base") == "minimum-near"),
          storage_(storage(params)),
          windows_(clip_options(params)),
          cache_(params.boolean("cache")),
          layout_(height_layout(params)),
          fetches_(fetches(params)),
          defines_{{"PGM_LEVEL", level_rule(params)},
                   {"PGM_INTERPOLATION", interpolation_rule(params)},
                   {"PGM_ROWS", grid_.denser_at_horizon ? "PGM_DENSER_AT_HORIZON" : "PGM_UNIFORM"},
                   {"PGM_HEIGHTS", name_in_shader(layout_)},
                   {"PGM_FETCHES", name_in_shader(fetches_)}} {
        if (params.choice("fetches") == "1-interpolated") {
            defines_["PGM_INTERPOLATED_COORDINATES"] = "";
        }
    }

    void prepare(const Terrain& terrain, gl::Device& device) override {
        info_ = terrain.info();
        if (level_count(info_) > int(kMaximumLevels)) {
            throw InputError(fmt::format(
                "pgm has room for {} levels, {} x {} samples have {}; use a smaller terrain",
                kMaximumLevels, info_.columns, info_.rows, level_count(info_)));
        }
        if (in_windows()) {
            require_plain();
            require_texture(device, ClipWindows::texture_size(level_count(info_), windows_.texels),
                            "lower window");
            heights_ = std::make_unique<ClipAtlas>(terrain, windows_, cache_);
        } else {
            require_texture(device, whole_layout(info_).size, "choose storage = \"windows\"");
            heights_ = std::make_unique<WholeAtlas>(terrain, layout_);
            if (fetches_ != Fetches::shared) colours_.emplace(terrain, fetches_);
        }
        if (base_near_ground_) local_minimum_ = LocalMinimum(terrain);
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        name_levels();
        program_ = gl::Program(device, "pgm", embedded_shaders(),
                               {{GL_VERTEX_SHADER, "pgm.vert"},
                                {GL_FRAGMENT_SHADER,
                                 fetches_ == Fetches::shared ? "common/terrain.frag" : "pgm.frag"}},
                               defines_);
        heights_->upload(device);
        if (colours_) colours_->upload(device);
        block_ = {};
        block_.grid = {grid_.columns, grid_.rows, level_count(info_), 0};
        mapping_buffer_ =
            gl::Buffer(device, "pgm: mapping", sizeof block_, GL_DYNAMIC_STORAGE_BIT, &block_);
        const auto indices = grid_indices(grid_);
        index_count_ = GLsizei(indices.size());
        indices_ = gl::Buffer(device, "pgm: grid", std::span<const std::uint32_t>(indices));
        vertices_ = gl::VertexArray(device, "pgm: grid");
        vertices_.elements(indices_);
    }

    void select(const Camera& camera, const Clock&) override {
        const glm::dvec2 east_north = (glm::dvec2(camera.position) - info_.origin) / info_.spacing;
        place_ = {east_north.x, info_.rows - 1 - east_north.y};
        base_height_ = base_near_ground_ ? local_minimum_.at(place_) : 0;
        mapping_ = make_mapping(camera, info_, base_height_, coverage_, grid_);
        heights_->follow(place_, settled_);
        freeze();
    }

    /// From the first call on every `select` waits for all that its windows lack.
    void settle() override {
        if (settled_) return;
        settled_ = true;
        heights_->follow(place_, true);
        freeze();
    }

    void draw(const View&) override {
        mapping_buffer_.bind_uniform(kMappingBinding);
        heights_->bind();
        if (colours_) colours_->bind();
        device_->draw_elements(program_, vertices_, GL_TRIANGLES, index_count_, GL_UNSIGNED_INT);
    }

    void pause_background() override { heights_->pause(); }
    void resume_background() override { heights_->resume(); }

    [[nodiscard]] Counters counters() const override {
        Counters counters = {{"auxiliary_pitch_degrees", mapping_.pitch * 57.295779513082320},
                             {"auxiliary_restricted", mapping_.restricted ? 1.0 : 0.0},
                             {"base_height_m", base_height_},
                             {"eye_height_above_base_m", mapping_.eye_height}};
        heights_->add_counters(counters);
        return counters;
    }

    void release(gl::Device&) override {
        vertices_ = {};
        indices_ = {};
        mapping_buffer_ = {};
        heights_->release();
        if (colours_) colours_->release();
        program_ = {};
    }

private:
    [[nodiscard]] bool in_windows() const {
        // 4097 x 4097 samples: 90 MiB with the pyramid.
        constexpr std::int64_t kMostWhole = std::int64_t(4097) * 4097;
        return storage_ == Storage::windows ||
               (storage_ == Storage::automatic &&
                std::int64_t(info_.rows) * info_.columns > kMostWhole);
    }
    /// What windows cannot hold.
    void require_plain() const {
        if (layout_ == HeightLayout::floats && fetches_ == Fetches::shared) return;
        throw InputError(fmt::format(
            "packing and the colour map are in core only, and {} x {} samples are in clip windows; "
            "choose storage = \"whole\", or packing = false and fetches = \"shared\"",
            info_.columns, info_.rows));
    }
    /// The cases of the shaders' switches, where each level has a texture of its own.
    void name_levels() {
        constexpr int kMostTextures = 16;  // of a stage, as every device has
        const int levels = level_count(info_);
        if (layout_ == HeightLayout::texture_a_level && levels > kMostTextures) {
            throw InputError(fmt::format(
                "fetches = \"multi-texture\" needs {} textures for {} x {} samples, more than {}; "
                "choose 1 or 2",
                levels, info_.columns, info_.rows, kMostTextures));
        }
        std::string cases;
        for (int level = 0; level < levels; ++level) cases += fmt::format("PGM_CASE({}) ", level);
        defines_["PGM_TEXTURES"] = std::to_string(levels);
        defines_["PGM_CASES"] = cases;
    }
    void require_texture(const gl::Device& device, glm::ivec2 size, const char* remedy) const {
        const int limit = device.info().max_texture_size;
        if (size.x <= limit && size.y <= limit) return;
        throw EnvironmentError(
            fmt::format("pgm holds the pyramid of {} x {} samples in one texture of {} x {}, more "
                        "than the {} x {} that this driver allows; {}",
                        info_.columns, info_.rows, size.x, size.y, limit, limit, remedy));
    }
    void freeze() {
        block_.ray_first = glm::dvec4(mapping_.first, mapping_.eye_height);
        block_.ray_across = glm::dvec4(mapping_.across, mapping_.far_distance);
        block_.ray_down = glm::dvec4(mapping_.down, std::sin(mapping_.ray_angle));
        block_.sampling =
            glm::dvec4(std::cos(mapping_.ray_angle), 1 / std::max(info_.spacing.x, info_.spacing.y),
                       2 / (windows_.texels * std::min(info_.spacing.x, info_.spacing.y)), 0);
        heights_->describe(block_);
        mapping_buffer_.write(0, sizeof block_, &block_);
    }

    GridSize grid_;
    Coverage coverage_;
    bool base_near_ground_;
    Storage storage_;
    ClipOptions windows_;
    bool cache_;
    HeightLayout layout_;
    Fetches fetches_;
    std::map<std::string, std::string> defines_;  ///< of the program
    TerrainInfo info_;
    LocalMinimum local_minimum_;
    std::unique_ptr<HeightAtlas> heights_;
    std::optional<ColourMap> colours_;
    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Buffer mapping_buffer_, indices_;
    gl::VertexArray vertices_;
    GLsizei index_count_ = 0;
    MappingBlock block_{};
    Mapping mapping_;
    glm::dvec2 place_{0};  ///< of the viewpoint, in samples
    double base_height_ = 0;
    bool settled_ = false;
};

constexpr ParamSpec kParams[] = {
    integer_param("grid", 600, 2, 4096,
                  "rows of the grid: vertices from top to bottom of the picture"),
    real_param("aspect", 0.25, 0.05, 20, "columns of the grid per row (150 x 600: 0.25)"),
    choice_param("rows", "uniform", "uniform|horizon",
                 "how the rows lie in the picture: evenly, or closer to the horizon"),
    real_param("margin", 0.05, 0, 1, "part by which the grid extends beyond the picture"),
    boolean_param("extend", true, "extends the vertical field of view to 90 degrees at least"),
    choice_param("base", "zero", "zero|minimum-near",
                 "base plane: z = 0 as in the paper, or the lowest ground near the viewpoint"),
    choice_param("level", "spacing", "spacing|distance",
                 "what chooses the level of detail: the distance r between vertices, or that to "
                 "the viewpoint, equation (4)"),
    choice_param("spacing", "neighbour", "neighbour|formula",
                 "r: the distance to the farthest adjacent vertex, or equation (3)"),
    choice_param("interpolation", "parent", "nearest|bilinear|parent",
                 "one texel; four; or four and, blended in, four of the coarser level"),
    boolean_param("finest_only", false, "samples the finest level alone, without the pyramid"),
    integer_param("window", 512, 64, 2048,
                  "texels along an edge of a clip window, a power of two; level = distance "
                  "measures by half the finest"),
    choice_param(
        "fetches", "shared", "shared|multi-texture|2|1|1-with-parent|1-interpolated",
        "of the colour map for each fragment: 2 or 1 of one texture; 1 with the parent, in "
        "16 bits; 1 at the vertices' coordinates (figure 14); a texture a level, heights "
        "too; shared: no map, the shading that all methods share"),
    boolean_param("packing", false,
                  "a vertex reads its height in one fetch, in steps of 1/65535 of the range"),
    choice_param("storage", "auto", "auto|whole|windows",
                 "whole: the pyramid is one texture; windows: clip windows about the viewpoint, "
                 "filled from a file; auto: whole up to 4097 x 4097 samples"),
    choice_param("update", "toroidal", "toroidal|entire",
                 "of the windows: what a move brings in, or all of them in every frame"),
    integer_param("lines_per_frame", 64, 1, 65536,
                  "rows and columns of the windows that are written in a frame at most; without "
                  "limit in lockstep"),
    integer_param("loader_threads", 2, 1, 16, "threads that read what the windows lack"),
    boolean_param("cache", true,
                  "keeps the pyramid's file for the next time; false: makes it anew")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "pgm",
     .title = "Persistent grid mapping: a screen grid mapped onto the terrain by the GPU",
     .citation =
         "Yotam Livny, Neta Sokolovsky, Tal Grinshpoun, Jihad El-Sana (2006): Persistent Grid "
         "Mapping: A GPU-based Framework for Interactive Terrain Rendering",
     .version = "2",
     .capabilities = kAsynchronous | kOutOfCore,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = "grid",
     .claimed_bound = nullptr,
     .create = create_method<PersistentGrid>,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::persistent_grid

LODBENCH_PLUGIN(lodbench::persistent_grid::kMethods);
