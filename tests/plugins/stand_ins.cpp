// Not broken: methods that stand in for those of methods/ in tests of the harness, so that each of
// the latter can be deleted. `every-sample` is exact and has no knob; `refined` has a knob that is
// its claimed bound, and keeps it; `strided` has a whole number for a knob, claims nothing, may
// leave ground uncovered, and is said to be asynchronous and out of core, though nothing is done in
// the background.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/leb_refiner.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

using Indices = std::vector<std::uint32_t>;

/// The terrain's samples as vertices, row by row; which of them are drawn is the derived class's.
class SampleMesh : public QuietMethod {
public:
    using QuietMethod::QuietMethod;

    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        const int rows = terrain.info().rows, columns = terrain.info().columns;
        std::vector<float> heights(std::size_t(rows) * std::size_t(columns));
        terrain.read({0, 0, rows, columns}, heights);
        take(rows, columns, [&](int row, int column) {
            return heights[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
        });
    }
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(
            device, "stand_ins", lodbench::embedded_shaders(),
            {{GL_VERTEX_SHADER, "stand_ins.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        program_.set("columns", columns_);
        height_buffer_ =
            lodbench::gl::Buffer(device, "stand_ins: heights", std::span<const float>(heights_));
        vertices_ = lodbench::gl::VertexArray(device, "stand_ins: vertices");
        vertices_.attribute(0, 1, height_buffer_, 0, sizeof(float));
    }
    void draw(const lodbench::View&) override {
        device_->draw_elements(program_, vertices_, mode_, count_, GL_UNSIGNED_INT);
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        indices_ = {};
        height_buffer_ = {};
        program_ = {};
    }

protected:
    template <typename HeightAt>
    void take(int rows, int columns, HeightAt height_at) {
        rows_ = rows;
        columns_ = columns;
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                heights_.push_back(height_at(row, column));
            }
        }
    }
    [[nodiscard]] std::uint32_t vertex(int row, int column) const {
        return std::uint32_t(std::min(row, rows_ - 1)) * std::uint32_t(columns_) +
               std::uint32_t(std::min(column, columns_ - 1));
    }
    /// Triangles over each `step`-th sample, and over those of the border, without a share of the
    /// rows.
    [[nodiscard]] Indices grid_of(int step, double uncovered = 0) const {
        Indices indices;
        for (int row = int(uncovered * (rows_ - 1)); row < rows_ - 1; row += step) {
            for (int column = 0; column < columns_ - 1; column += step) {
                const std::uint32_t nw = vertex(row, column), ne = vertex(row, column + step),
                                    sw = vertex(row + step, column),
                                    se = vertex(row + step, column + step);
                indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
            }
        }
        return indices;
    }
    void draw_these(const Indices& indices, GLenum mode) {
        if (indices_.bytes() < indices.size() * sizeof(indices[0])) {
            indices_ = lodbench::gl::Buffer(*device_, "stand_ins: indices",
                                            indices.size() * sizeof(indices[0]));
            vertices_.elements(indices_);
        }
        indices_.write(std::span<const std::uint32_t>(indices));
        count_ = GLsizei(indices.size());
        mode_ = mode;
    }
    [[nodiscard]] int samples_a_side() const { return std::max(rows_, columns_); }

private:
    int rows_ = 0, columns_ = 0;
    std::vector<float> heights_;
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::Buffer height_buffer_, indices_;
    lodbench::gl::VertexArray vertices_;
    GLsizei count_ = 0;
    GLenum mode_ = GL_TRIANGLES;
};

class EverySample final : public SampleMesh {
public:
    using SampleMesh::SampleMesh;
    void upload(lodbench::gl::Device& device) override {
        SampleMesh::upload(device);
        draw_these(grid_of(1), GL_TRIANGLES);
    }
};

class Strided final : public SampleMesh {
public:
    explicit Strided(const lodbench::Params& params)
        : SampleMesh(params),
          vertices_a_side_(int(params.integer("vertices"))),
          uncovered_(params.real("uncovered")) {}
    void upload(lodbench::gl::Device& device) override {
        SampleMesh::upload(device);
        draw_these(
            grid_of(std::max(1, (samples_a_side() - 1) / (vertices_a_side_ - 1)), uncovered_),
            GL_TRIANGLES);
    }

private:
    int vertices_a_side_;
    double uncovered_;
};

/// By longest-edge bisection with the criterion that bounds the error.
class Refined final : public SampleMesh {
public:
    explicit Refined(const lodbench::Params& params)
        : SampleMesh(params),
          options_{.tau = params.real("tau"),
                   .error = lodbench::common::ErrorKind::accumulated,
                   .metric = lodbench::common::Metric::planar,
                   .culling = params.boolean("culling")} {}
    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        refiner_.emplace(terrain, options_);
        take(terrain.info().rows, terrain.info().columns, [this](int row, int column) {
            return refiner_->grid().at({row, column}).height;
        });
    }
    void select(const lodbench::Camera& camera, const lodbench::Clock&) override {
        const int size = refiner_->grid().size();
        Indices strip;
        for (const std::uint32_t padded : refiner_->refine(camera).indices()) {
            strip.push_back(vertex(int(padded) / size, int(padded) % size));
        }
        draw_these(strip, GL_TRIANGLE_STRIP);
    }
    [[nodiscard]] lodbench::Counters counters() const override {
        return {{"strip_triangles", double(refiner_->strip().triangle_count())}};
    }

private:
    lodbench::common::RefinerOptions options_;
    std::optional<lodbench::common::LebRefiner> refiner_;
};

constexpr lodbench::ParamSpec kRefined[] = {
    lodbench::real_param("tau", 1, 0.01, 1000, "bound of the screen error, pixels"),
    lodbench::boolean_param("culling", true, "coarsens what lies outside of the view")};
constexpr lodbench::ParamSpec kStrided[] = {
    lodbench::integer_param("vertices", 64, 2, 4096, "vertices along the longer side"),
    lodbench::real_param("uncovered", 0, 0, 1, "share of the rows, from the north, not drawn")};

template <typename T>
constexpr lodbench::MethodDescriptor with(const char* id, const lodbench::ParamSpec* params,
                                          std::size_t count, const char* knob) {
    lodbench::MethodDescriptor descriptor = quiet_descriptor<T>(id);
    descriptor.title = "Stands in for a method in tests of the harness";
    descriptor.params = params;
    descriptor.param_count = count;
    descriptor.quality_knob = knob;
    descriptor.capabilities = lodbench::kExample;  // what flies all methods leaves them out
    return descriptor;
}
constexpr lodbench::MethodDescriptor streaming(lodbench::MethodDescriptor descriptor) {
    descriptor.capabilities |= lodbench::kAsynchronous | lodbench::kOutOfCore;
    return descriptor;
}
constexpr lodbench::MethodDescriptor claiming(lodbench::MethodDescriptor descriptor) {
    descriptor.claimed_bound = descriptor.quality_knob;
    return descriptor;
}

constexpr lodbench::MethodDescriptor kMethods[] = {
    with<EverySample>("every-sample", nullptr, 0, nullptr),
    claiming(with<Refined>("refined", kRefined, std::size(kRefined), "tau")),
    streaming(with<Strided>("strided", kStrided, std::size(kStrided), "vertices"))};

}  // namespace

LODBENCH_PLUGIN(kMethods);
