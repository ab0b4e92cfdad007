// lindstrom: P. Lindstrom, V. Pascucci, "Terrain Simplification Simplified: A General Framework for
// View-Dependent Out-of-Core Visualization", IEEE TVCG 8(3), 2002. Nested spheres and saturated
// errors; the CPU refines into one generalised triangle strip a frame. What is CPU only lies in
// methods/common (leb_*.h); here it is uploaded and drawn. Parameters and deviations: README.md.

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "api/method.h"
#include "common/leb_heights.h"
#include "common/leb_refiner.h"
#include "gl/device.h"
#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace lodbench::lindstrom {
namespace {

// What the shader says.
static_assert(common::LebHeights::kBinding == 2 && common::LebHeights::kTextureUnit == 0);

common::RefinerOptions options_from(const Params& params) {
    return {.tau = params.real("tau"),
            .error = params.choice("error") == "accumulated" ? common::ErrorKind::accumulated
                                                             : common::ErrorKind::midpoint,
            .metric = params.choice("metric") == "planar" ? common::Metric::planar
                                                          : common::Metric::euclidean,
            .culling = params.boolean("culling"),
            .lambda = params.choice("lambda") == "angle" ? common::LambdaForm::angle
                                                         : common::LambdaForm::tangent,
            .morph = params.real("morph")};
}

/// What the strip's elements are: numbers of vertices, or, where they morph, vertices.
void attach(gl::VertexArray& vertices, const gl::Buffer& buffer, std::uint32_t) {
    vertices.elements(buffer);
}
void attach(gl::VertexArray& vertices, const gl::Buffer& buffer, common::MorphedVertex) {
    using common::MorphedVertex;
    constexpr auto kStride = sizeof(MorphedVertex);
    vertices.integer_attribute(0, 1, GL_UNSIGNED_INT, buffer, offsetof(MorphedVertex, index),
                               kStride);
    vertices.attribute(1, 1, buffer, offsetof(MorphedVertex, height), kStride);
}

/// A strip in one of three buffers in turn, so that writing the next frame's does not wait for the
/// GPU to finish with the last one's.
class StripRing {
public:
    template <typename Element>
    void write(gl::Device& device, std::span<const Element> strip) {
        current_ = (current_ + 1) % slots_.size();
        Slot& slot = slots_[current_];
        if (slot.strip.bytes() < strip.size_bytes()) {
            const std::string label = "lindstrom: strip " + std::to_string(current_);
            slot.vertices = gl::VertexArray(device, label);
            // Half as much again: a flight that slowly sees more grows the buffers a few times
            // only.
            slot.strip = gl::Buffer(device, label, strip.size_bytes() + strip.size_bytes() / 2);
            attach(slot.vertices, slot.strip, Element{});
        }
        slot.strip.write(strip);
    }
    [[nodiscard]] const gl::VertexArray& vertices() const { return slots_[current_].vertices; }

private:
    struct Slot {
        gl::Buffer strip;
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
        std::map<std::string, std::string> defines;
        if (refiner_->morph()) {
            defines["MORPH"] = "1";  // vertices bring their heights
        } else {
            heights_ =
                common::LebHeights(device, "lindstrom: heights", refiner_->grid(), rows_, columns_);
            defines = heights_.defines();
        }
        program_ = gl::Program(
            device, "lindstrom", embedded_shaders(),
            {{GL_VERTEX_SHADER, "lindstrom.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}},
            defines);
        program_.set("padded_size", refiner_->grid().size());
        if (!refiner_->morph()) {
            program_.set("terrain_size", glm::ivec2(columns_, rows_));
        }
    }

    void select(const Camera& camera, const Clock&) override {
        const common::LebStrip& strip = refiner_->refine(camera);
        if (const auto& morph = refiner_->morph()) {
            ring_.write(*device_, morph->vertices());
        } else {
            ring_.write(*device_, strip.indices());
        }
    }

    void draw(const View&) override {
        if (refiner_->morph()) {
            device_->draw_arrays(program_, ring_.vertices(), GL_TRIANGLE_STRIP, 0,
                                 GLsizei(refiner_->strip().indices().size()));
            return;
        }
        heights_.bind();
        device_->draw_elements(program_, ring_.vertices(), GL_TRIANGLE_STRIP,
                               GLsizei(refiner_->strip().indices().size()), GL_UNSIGNED_INT);
    }

    [[nodiscard]] Counters counters() const override {
        const common::LebStrip& strip = refiner_->strip();
        return {
            {"strip_indices", double(strip.indices().size())},
            {"triangles_without_swaps", double(strip.triangle_count())},
            {"vertices_morphing", refiner_->morph() ? double(refiner_->morph()->morphing()) : 0.0}};
    }

    void release(gl::Device&) override {
        ring_ = {};
        heights_ = {};
        program_ = {};
    }

private:
    common::RefinerOptions options_;
    int columns_ = 0;
    int rows_ = 0;
    std::optional<common::LebRefiner> refiner_;
    gl::Device* device_ = nullptr;
    gl::Program program_;
    common::LebHeights heights_;
    StripRing ring_;
};

constexpr ParamSpec kParams[] = {
    real_param("tau", 1, 0.01, 1000, "screen-space error tolerance, pixels"),
    choice_param(
        "error", "midpoint", "midpoint|accumulated",
        "object-space error: the paper's maximum of midpoint errors, or the largest sum along a "
        "path of descendants, which bounds the surface"),
    choice_param(
        "metric", "euclidean", "euclidean|planar",
        "distance: the paper's to the eye, or the depth with the image corner's secant, which "
        "bounds the error on a flat image"),
    boolean_param("culling", true, "coarsens what lies outside the view frustum"),
    choice_param("lambda", "tan", "tan|angle",
                 "pixels per unit of error over distance: height / (2 tan(fov / 2)), or height / "
                 "fov, which is larger"),
    real_param("morph", 1, 1, 100,
               "geomorphing: upper threshold over lower one, between which a vertex moves from its "
               "edge to its height; 1: none")};

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
