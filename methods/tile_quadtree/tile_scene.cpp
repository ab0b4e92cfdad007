#include "tile_quadtree/tile_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lodbench::tile_quadtree {

namespace {

// A tenth more to each side: what the region is read for is drawn a frame later. The ground between
// two texels is the shader's concern.
constexpr float kWidening = 1.1F;
// Below every -sample of a grid.
constexpr float kNothing = -4e9F;

}  // namespace

void TileScene::upload(gl::Device& device, std::span<const gl::ShaderSource> shaders,
                       int most_tiles) {
    device_ = &device;
    program_ =
        gl::Program(device, "tile_quadtree", shaders,
                    {{GL_VERTEX_SHADER, "tile.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
    region_program_ =
        gl::Program(device, "tile_quadtree: region", shaders,
                    {{GL_VERTEX_SHADER, "region.vert"}, {GL_FRAGMENT_SHADER, "region.frag"}});
    region_program_.set("widening", kWidening);
    mesh_ = tile_mesh();
    indices_ =
        gl::Buffer(device, "tile_quadtree: cells", std::span<const std::uint16_t>(mesh_.indices));
    instances_ = gl::Buffer(device, "tile_quadtree: drawn tiles",
                            std::size_t(most_tiles) * sizeof(Instance));
    vertices_ = gl::VertexArray(device, "tile_quadtree");
    constexpr GLsizei kStride = sizeof(Instance);
    vertices_.integer_attribute(0, 4, GL_INT, instances_, offsetof(Instance, slot), kStride, 1);
    vertices_.integer_attribute(1, 4, GL_INT, instances_, offsetof(Instance, coarser), kStride, 1);
    vertices_.integer_attribute(2, 1, GL_INT, instances_, offsetof(Instance, coarsened), kStride,
                                1);
    vertices_.attribute(3, 1, instances_, offsetof(Instance, foot), kStride, 1);
    vertices_.elements(indices_);
    region_texture_ = gl::Texture(device, "tile_quadtree: region", GL_TEXTURE_2D, GL_RGBA32F,
                                  region_pixels_, region_pixels_);
    region_framebuffer_ =
        gl::Framebuffer(device, "tile_quadtree: region", &region_texture_, nullptr);
}

void TileScene::release() {
    *this = TileScene(cracks_, region_pixels_);
}

void TileScene::freeze(std::span<const DrawnTile> tiles, const TileCatalogue& catalogue,
                       const common::TileStreamer& streamer) {
    staged_.clear();
    const double step = std::min(catalogue.info().spacing.x, catalogue.info().spacing.y);
    for (const DrawnTile& drawn : tiles) {
        const TileId& tile = drawn.tile;
        Instance& instance = staged_.emplace_back();
        instance.slot = streamer.slot(drawn.source()).value();
        instance.level = tile.level;
        instance.row = tile.row;
        instance.column = tile.column;
        for (std::size_t edge = 0; edge < 4; ++edge) {
            instance.coarser[edge] =
                cracks_ == Cracks::snap ? drawn.edges.coarser[edge] : drawn.coarsened;
        }
        instance.coarsened = drawn.coarsened;
        // Of a line of samples that two tiles share, each draws some and interpolates: no gap
        // between them reaches below the line's lowest sample. A sixteenth of a cell more, for what
        // the rasteriser leaves open on flat ground.
        instance.foot = float(double(catalogue.summary(tile).min_height) -
                              step * double(std::int64_t(1) << tile.level) / 16);
    }
    count_ = int(staged_.size());
    if (count_ > 0) instances_.write(std::span<const Instance>(staged_));
}

void TileScene::draw(const common::TileStreamer& streamer) {
    if (count_ == 0) return;
    streamer.heights().bind(0);
    const int indices = mesh_.tile_count + (cracks_ == Cracks::skirt ? mesh_.skirt_count : 0);
    device_->draw_elements(program_, vertices_, GL_TRIANGLES, indices, GL_UNSIGNED_SHORT, 0,
                           count_);
}

void TileScene::ask_region(const common::TileStreamer& streamer) {
    constexpr float kClear[] = {kNothing, kNothing, kNothing, kNothing};
    glClearNamedFramebufferfv(region_framebuffer_.name(), GL_COLOR, 0, kClear);
    if (count_ > 0) {
        const OffscreenPass pass(region_framebuffer_, region_pixels_, region_pixels_, true);
        streamer.heights().bind(0);
        device_->draw_elements(region_program_, vertices_, GL_TRIANGLES, mesh_.coarse_count,
                               GL_UNSIGNED_SHORT,
                               std::size_t(mesh_.coarse_first) * sizeof(std::uint16_t), count_);
    }
    region_readback_.begin(*device_, "tile_quadtree: region", region_texture_, region_pixels_,
                           region_pixels_, GL_RGBA, GL_FLOAT);
}

SampleBox TileScene::region(const TileCatalogue& catalogue) {
    bounds_.resize(std::size_t(region_pixels_) * std::size_t(region_pixels_));
    region_readback_.read(bounds_.data());
    glm::vec4 greatest(kNothing);
    for (const glm::vec4& texel : bounds_) greatest = glm::max(greatest, texel);
    if (greatest.z <= kNothing) return {};
    const SampleBox whole = catalogue.whole();
    const auto sample = [](float value, int last) {
        return int(std::clamp(double(value), 0.0, double(last)));
    };
    return {sample(std::floor(-greatest.y), whole.last_row),
            sample(std::floor(-greatest.x), whole.last_column),
            sample(std::ceil(greatest.w), whole.last_row),
            sample(std::ceil(greatest.z), whole.last_column)};
}

}  // namespace lodbench::tile_quadtree
