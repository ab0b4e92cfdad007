// Numerically unstable on purpose, and faultless in a mild setting. `float-world` sends world
// coordinates to the GPU as floats. `blind-metric` divides a block's error by its distance less its
// radius, whatever the sign: inside of the sphere the quotient is negative, and the block as coarse
// as can be.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

using Indices = std::vector<std::uint32_t>;

/// The terrain's samples as vertices, row by row.
class Samples : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        info_ = terrain.info();
        heights_.resize(std::size_t(info_.rows) * std::size_t(info_.columns));
        terrain.read({0, 0, info_.rows, info_.columns}, heights_);
    }
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(
            device, "unstable", lodbench::embedded_shaders(),
            {{GL_VERTEX_SHADER, "unstable.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        program_.set("columns", info_.columns);
        height_buffer_ =
            lodbench::gl::Buffer(device, "unstable: heights", std::span<const float>(heights_));
        vertices_ = lodbench::gl::VertexArray(device, "unstable: vertices");
        vertices_.attribute(0, 1, height_buffer_, 0, sizeof(float));
        // Each sample's two triangles, at most.
        indices_ = lodbench::gl::Buffer(device, "unstable: indices",
                                        6 * heights_.size() * sizeof(std::uint32_t));
        vertices_.elements(indices_);
    }
    void select(const lodbench::Camera& camera, const lodbench::Clock&) override {
        const Indices indices = chosen(camera);
        indices_.write(std::span<const std::uint32_t>(indices));
        count_ = GLsizei(indices.size());
        world_eye_ = glm::vec3(camera.position);
    }
    void draw(const lodbench::View&) override {
        program_.set("float_world", float_world() ? 1 : 0);
        program_.set("world_eye", world_eye_);
        program_.set("world_origin", glm::vec3(glm::dvec3(info_.origin, 0)));
        device_->draw_elements(program_, vertices_, GL_TRIANGLES, count_, GL_UNSIGNED_INT);
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        indices_ = {};
        height_buffer_ = {};
        program_ = {};
    }

protected:
    [[nodiscard]] virtual Indices chosen(const lodbench::Camera& camera) const = 0;
    [[nodiscard]] virtual bool float_world() const { return false; }
    [[nodiscard]] std::uint32_t vertex(int row, int column) const {
        return std::uint32_t(row) * std::uint32_t(info_.columns) + std::uint32_t(column);
    }
    /// Two triangles over a rectangle of samples.
    void add(Indices& indices, int north, int west, int south, int east) const {
        const std::uint32_t nw = vertex(north, west), ne = vertex(north, east),
                            sw = vertex(south, west), se = vertex(south, east);
        indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
    }
    [[nodiscard]] float height(int row, int column) const { return heights_[vertex(row, column)]; }

    lodbench::TerrainInfo info_;

private:
    std::vector<float> heights_;
    glm::vec3 world_eye_{0.0F};
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::Buffer height_buffer_, indices_;
    lodbench::gl::VertexArray vertices_;
    GLsizei count_ = 0;
};

class FloatWorld final : public Samples {
public:
    using Samples::Samples;

private:
    [[nodiscard]] bool float_world() const override { return true; }
    [[nodiscard]] Indices chosen(const lodbench::Camera&) const override {
        Indices indices;
        for (int row = 0; row + 1 < info_.rows; ++row) {
            for (int column = 0; column + 1 < info_.columns; ++column) {
                add(indices, row, column, row + 1, column + 1);
            }
        }
        return indices;
    }
};

/// Blocks of 4 x 4 cells, each drawn whole or as two triangles.
class BlindMetric final : public Samples {
public:
    explicit BlindMetric(const lodbench::Params& params)
        : Samples(params), tau_(params.real("tau")) {}

private:
    static constexpr int kCells = 4;

    /// Greatest distance of a sample from the block's two triangles, and what bounds the block.
    struct Block {
        int north, west, south, east;
        double error = 0;
        glm::dvec3 low{0.0}, high{0.0};
    };
    [[nodiscard]] Block block_at(int row, int column) const {
        Block block{row, column, std::min(row + kCells, info_.rows - 1),
                    std::min(column + kCells, info_.columns - 1)};
        const double nw = height(block.north, block.west), ne = height(block.north, block.east),
                     sw = height(block.south, block.west), se = height(block.south, block.east);
        block.low = {info_.position(block.south, block.west), nw};
        block.high = {info_.position(block.north, block.east), nw};
        for (int r = block.north; r <= block.south; ++r) {
            for (int c = block.west; c <= block.east; ++c) {
                const double v = double(r - block.north) / (block.south - block.north);
                const double u = double(c - block.west) / (block.east - block.west);
                const double plane =
                    u < v ? nw + v * (sw - nw) + u * (se - sw) : nw + u * (ne - nw) + v * (se - ne);
                block.error = std::max(block.error, std::abs(double(height(r, c)) - plane));
                block.low.z = std::min(block.low.z, double(height(r, c)));
                block.high.z = std::max(block.high.z, double(height(r, c)));
            }
        }
        return block;
    }
    [[nodiscard]] Indices chosen(const lodbench::Camera& camera) const override {
        Indices indices;
        for (int row = 0; row + 1 < info_.rows; row += kCells) {
            for (int column = 0; column + 1 < info_.columns; column += kCells) {
                const Block block = block_at(row, column);
                const double radius = 0.5 * glm::length(block.high - block.low);
                const double distance =
                    glm::length(camera.position - 0.5 * (block.low + block.high));
                // The fault. And a sixteenth of tau: the corners of a picture stretch what is
                // there, and a crack as wide as that is not seen.
                const double px = camera.lambda() * block.error / (distance - radius);
                if (px <= tau_ / 16) {
                    add(indices, block.north, block.west, block.south, block.east);
                    continue;
                }
                for (int r = block.north; r < block.south; ++r) {
                    for (int c = block.west; c < block.east; ++c) add(indices, r, c, r + 1, c + 1);
                }
            }
        }
        return indices;
    }
    double tau_;
};

constexpr lodbench::ParamSpec kTau[] = {
    lodbench::real_param("tau", 1, 0.01, 1000, "bound of the screen error, pixels")};

constexpr lodbench::MethodDescriptor example(lodbench::MethodDescriptor descriptor) {
    descriptor.capabilities = lodbench::kExample;  // what flies all methods leaves them out
    return descriptor;
}
constexpr lodbench::MethodDescriptor bounded(lodbench::MethodDescriptor descriptor) {
    descriptor.params = kTau;
    descriptor.param_count = std::size(kTau);
    descriptor.quality_knob = descriptor.claimed_bound = "tau";
    return descriptor;
}

constexpr lodbench::MethodDescriptor kMethods[] = {
    example(quiet_descriptor<FloatWorld>("float-world")),
    bounded(example(quiet_descriptor<BlindMetric>("blind-metric")))};

}  // namespace

LODBENCH_PLUGIN(kMethods);
