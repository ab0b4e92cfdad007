// lindstrom: P. Lindstrom, V. Pascucci, "Terrain Simplification Simplified: A General Framework for
// View-Dependent Out-of-Core Visualization", IEEE TVCG 8(3), 2002. Nested spheres and saturated
// errors; the CPU refines into one generalised triangle strip a frame. What is CPU only lies in
// methods/common (leb_*.h); here it is uploaded and drawn. Parameters and deviations: README.md.

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "api/method.h"
#include "common/leb_refiner.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::lindstrom {
namespace {

constexpr GLuint kHeightsBinding = gl::kFirstFreeBinding;  // the shader says 2
static_assert(kHeightsBinding == 2);

common::RefinerOptions options_from(const Params& params) {
    return {.tau = params.real("tau"),
            .error = params.choice("error") == "accumulated" ? common::ErrorKind::accumulated
                                                             : common::ErrorKind::midpoint,
            .metric = params.choice("metric") == "planar" ? common::Metric::planar
                                                          : common::Metric::euclidean,
            .culling = params.boolean("culling")};
}

/// A strip's indices in one of three buffers in turn, so that writing the next frame's does not
/// wait for the GPU to finish with the last one's.
class StripRing {
public:
    void write(gl::Device& device, std::span<const std::uint32_t> indices) {
        current_ = (current_ + 1) % slots_.size();
        Slot& slot = slots_[current_];
        if (slot.indices.bytes() < indices.size_bytes()) {
            const std::string label = "lindstrom: strip " + std::to_string(current_);
            slot.vertices = gl::VertexArray(device, label);
            // Half as much again: a flight that slowly sees more grows the buffers a few times
            // only.
            slot.indices =
                gl::Buffer(device, label, indices.size_bytes() + indices.size_bytes() / 2);
            slot.vertices.elements(slot.indices);
        }
        slot.indices.write(indices);
    }
    [[nodiscard]] const gl::VertexArray& vertices() const { return slots_[current_].vertices; }

private:
    struct Slot {
        gl::Buffer indices;
        gl::VertexArray vertices;
    };
    std::array<Slot, 3> slots_;
    std::size_t current_ = 0;
};

class Lindstrom final : public Method {
public:
    explicit Lindstrom(const Params& params) : options_(options_from(params)) {}

    void prepare(const Terrain& terrain, gl::Device&) override {
        columns_ = terrain.info().columns;
        rows_ = terrain.info().rows;
        refiner_.emplace(terrain, options_);
    }

    void upload(gl::Device& device) override {
        device_ = &device;
        const int limit = device.info().max_texture_size;
        const bool in_buffer = columns_ > limit || rows_ > limit;
        program_ = gl::Program(
            device, "lindstrom", embedded_shaders(),
            {{GL_VERTEX_SHADER, "lindstrom.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}},
            in_buffer ? std::map<std::string, std::string>{{"HEIGHTS_IN_BUFFER", "1"}}
                      : std::map<std::string, std::string>{});
        program_.set("padded_size", refiner_->grid().size());
        program_.set("terrain_size", glm::ivec2(columns_, rows_));
        if (in_buffer) {
            heights_buffer_ =
                gl::Buffer(device, "lindstrom: heights",
                           std::size_t(rows_) * std::size_t(columns_) * sizeof(float));
        } else {
            heights_texture_ =
                gl::Texture(device, "lindstrom: heights", GL_TEXTURE_2D, GL_R32F, columns_, rows_);
            heights_texture_.set_parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST);
            heights_texture_.set_parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        }
        upload_heights();
    }

    void select(const Camera& camera, const Clock&) override {
        ring_.write(*device_, refiner_->refine(camera).indices());
    }

    void draw(const View&) override {
        if (heights_buffer_) {
            heights_buffer_.bind_storage(kHeightsBinding);
        } else {
            heights_texture_.bind(0);
        }
        device_->draw_elements(program_, ring_.vertices(), GL_TRIANGLE_STRIP,
                               GLsizei(refiner_->strip().indices().size()), GL_UNSIGNED_INT);
    }

    [[nodiscard]] Counters counters() const override {
        const common::LebStrip& strip = refiner_->strip();
        return {{"strip_indices", double(strip.indices().size())},
                {"triangles_without_swaps", double(strip.triangle_count())}};
    }

    void release(gl::Device&) override {
        ring_ = {};
        heights_buffer_ = {};
        heights_texture_ = {};
        program_ = {};
    }

private:
    /// From the grid, in bands of rows: the terrain is read once, and no second copy of it is made.
    void upload_heights() {
        constexpr int kBand = 64;
        std::vector<float> band(std::size_t(kBand) * std::size_t(columns_));
        for (int first = 0; first < rows_; first += kBand) {
            const int rows = std::min(kBand, rows_ - first);
            float* out = band.data();
            for (int row = first; row < first + rows; ++row) {
                const common::LebVertex* vertex = &refiner_->grid().at({row, 0});
                for (int column = 0; column < columns_; ++column) *out++ = vertex[column].height;
            }
            if (heights_buffer_) {
                const std::size_t offset =
                    std::size_t(first) * std::size_t(columns_) * sizeof(float);
                heights_buffer_.write(offset, std::size_t(out - band.data()) * sizeof(float),
                                      band.data());
            } else {
                heights_texture_.write(0, 0, first, columns_, rows, GL_RED, GL_FLOAT, band.data());
            }
        }
    }

    common::RefinerOptions options_;
    int columns_ = 0;
    int rows_ = 0;
    std::optional<common::LebRefiner> refiner_;
    gl::Device* device_ = nullptr;
    gl::Program program_;
    gl::Texture heights_texture_;
    gl::Buffer heights_buffer_;  ///< instead of the texture where the terrain exceeds its limit
    StripRing ring_;
};

constexpr ParamSpec kParams[] = {
    real_param("tau", 1, 0.01, 1000, "screen-space error tolerance, pixels"),
    choice_param(
        "error", "midpoint", "midpoint|accumulated",
        "object-space error: the paper's maximum of midpoint errors, or their sum down the "
        "hierarchy, which bounds the surface"),
    choice_param(
        "metric", "euclidean", "euclidean|planar",
        "distance: the paper's to the eye, or the depth with the image corner's secant, which "
        "bounds the error on a flat image"),
    boolean_param("culling", true, "coarsens what lies outside the view frustum")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "lindstrom",
     .title = "Lindstrom & Pascucci: nested spheres, refined on the CPU, one strip a frame",
     .citation = "P. Lindstrom, V. Pascucci, 2002, Terrain Simplification Simplified: A General "
                 "Framework for View-Dependent Out-of-Core Visualization",
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kParams,
     .param_count = std::size(kParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_method<Lindstrom>,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::lindstrom

LODBENCH_PLUGIN(lodbench::lindstrom::kMethods);
