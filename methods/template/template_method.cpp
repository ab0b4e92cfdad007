// The smallest method: every `step`-th sample of the terrain as one regular grid, whatever the
// camera. Cite the paper here (authors, title, year), and say on the line where the code departs
// from it.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "api/method.h"           // the whole interface, with the rules of each call
#include "gl/device.h"            // draw calls go through the device: it counts and captures them
#include "gl/embedded_shaders.h"  // the shaders that CMakeLists.txt names
#include "gl/objects.h"
#include "gl/program.h"

namespace {

class TemplateMethod final : public lodbench::Method {
public:
    // Values are complete and in range: the host has checked them against kParams below.
    explicit TemplateMethod(const lodbench::Params& params) : step_(int(params.integer("step"))) {}

    // Preprocessing, timed as such: read what is needed, and no more (what is read is counted).
    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        const int rows = terrain.info().rows, columns = terrain.info().columns;
        // Rounded up, so that the last vertex of each line stands on the border.
        grid_rows_ = (rows - 2) / step_ + 2;
        grid_columns_ = (columns - 2) / step_ + 2;
        std::vector<float> row(static_cast<std::size_t>(columns));
        for (int j = 0; j < grid_rows_; ++j) {
            terrain.read({std::min(j * step_, rows - 1), 0, 1, columns}, row);
            for (int i = 0; i < grid_columns_; ++i) {
                heights_.push_back(row[static_cast<std::size_t>(std::min(i * step_, columns - 1))]);
            }
        }
    }

    // GPU objects. Each has a name, which messages of the driver will quote.
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(device, "template_method", lodbench::embedded_shaders(),
                                         {{GL_VERTEX_SHADER, "template_method.vert"},
                                          {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        // One height a vertex; the shader knows the rest from the vertex's number.
        height_buffer_ = lodbench::gl::Buffer(device, "template_method: heights",
                                              std::span<const float>(heights_));
        std::vector<std::uint32_t> indices;
        for (int j = 0; j + 1 < grid_rows_; ++j) {
            for (int i = 0; i + 1 < grid_columns_; ++i) {
                const auto nw = static_cast<std::uint32_t>(j * grid_columns_ + i), ne = nw + 1;
                const auto sw = nw + static_cast<std::uint32_t>(grid_columns_), se = sw + 1;
                indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
            }
        }
        index_count_ = static_cast<GLsizei>(indices.size());
        index_buffer_ = lodbench::gl::Buffer(device, "template_method: indices",
                                             std::span<const std::uint32_t>(indices));
        vertices_ = lodbench::gl::VertexArray(device, "template_method: vertices");
        vertices_.attribute(0, 1, height_buffer_, 0, sizeof(float));
        vertices_.elements(index_buffer_);
    }

    // Each frame: decide what to draw for this camera, and leave it so until the next call. A real
    // method chooses its level of detail here; this one draws the same grid always.
    void select(const lodbench::Camera&, const lodbench::Clock&) override {}

    // Draw what was selected. The view may differ from the selected camera: only the `Frame` block,
    // which the shaders of common/ use, may depend on it.
    void draw(const lodbench::View&) override {
        program_.set("step_samples", step_);
        program_.set("grid_columns", grid_columns_);
        device_->draw_elements(program_, vertices_, GL_TRIANGLES, index_count_, GL_UNSIGNED_INT);
    }

    // Figures of the last frame that only the method knows; triangles and bytes are counted for
    // you.
    [[nodiscard]] lodbench::Counters counters() const override {
        return {{"grid_vertices", double(grid_rows_) * grid_columns_}};
    }

    // Give every GPU object back: the context is current for the last time.
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        index_buffer_ = {};
        height_buffer_ = {};
        program_ = {};
    }

private:
    int step_;
    int grid_rows_ = 0, grid_columns_ = 0;
    std::vector<float> heights_;
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::Buffer height_buffer_, index_buffer_;
    lodbench::gl::VertexArray vertices_;
    GLsizei index_count_ = 0;
};

constexpr lodbench::ParamSpec kParams[] = {lodbench::integer_param(
    "step", 8, 1, 1024, "samples between two vertices; 1 draws every sample")};

constexpr lodbench::MethodDescriptor kMethods[] = {
    {.id = "template",
     .title = "Every step-th sample as one regular grid",
     .citation = "",
     .version = "1",
     .capabilities = lodbench::kExample,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = "step",
     .claimed_bound = nullptr,  // the parameter that bounds the screen error in pixels, if one does
     .create = lodbench::create_method<TemplateMethod>,
     .destroy = lodbench::destroy_method}};

}  // namespace

LODBENCH_PLUGIN(kMethods);
