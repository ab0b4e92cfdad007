#include "gl/host/state.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "gl/device.h"

namespace lodbench::gl {

namespace {

struct Capability {
    GLenum name;
    const char* text;
};
#define CAPABILITY(name_) \
    Capability {          \
        name_, #name_     \
    }
constexpr Capability kCapabilities[] = {
    CAPABILITY(GL_DEPTH_TEST),
    CAPABILITY(GL_SCISSOR_TEST),
    CAPABILITY(GL_STENCIL_TEST),
    CAPABILITY(GL_BLEND),
    CAPABILITY(GL_COLOR_LOGIC_OP),
    CAPABILITY(GL_DITHER),
    CAPABILITY(GL_CULL_FACE),
    CAPABILITY(GL_DEPTH_CLAMP),
    CAPABILITY(GL_RASTERIZER_DISCARD),
    CAPABILITY(GL_POLYGON_OFFSET_FILL),
    CAPABILITY(GL_POLYGON_OFFSET_LINE),
    CAPABILITY(GL_POLYGON_OFFSET_POINT),
    CAPABILITY(GL_POLYGON_SMOOTH),
    CAPABILITY(GL_LINE_SMOOTH),
    CAPABILITY(GL_PRIMITIVE_RESTART),
    CAPABILITY(GL_PRIMITIVE_RESTART_FIXED_INDEX),
    CAPABILITY(GL_MULTISAMPLE),
    CAPABILITY(GL_SAMPLE_ALPHA_TO_COVERAGE),
    CAPABILITY(GL_SAMPLE_ALPHA_TO_ONE),
    CAPABILITY(GL_SAMPLE_COVERAGE),
    CAPABILITY(GL_SAMPLE_MASK),
    CAPABILITY(GL_SAMPLE_SHADING),
    CAPABILITY(GL_FRAMEBUFFER_SRGB),
    CAPABILITY(GL_PROGRAM_POINT_SIZE),
    CAPABILITY(GL_TEXTURE_CUBE_MAP_SEAMLESS),
    CAPABILITY(GL_CLIP_DISTANCE0),
    CAPABILITY(GL_CLIP_DISTANCE1),
    CAPABILITY(GL_CLIP_DISTANCE2),
    CAPABILITY(GL_CLIP_DISTANCE3),
    CAPABILITY(GL_CLIP_DISTANCE4),
    CAPABILITY(GL_CLIP_DISTANCE5),
    CAPABILITY(GL_CLIP_DISTANCE6),
    CAPABILITY(GL_CLIP_DISTANCE7),
    // A method that silences the driver would hide its errors.
    CAPABILITY(GL_DEBUG_OUTPUT),
    CAPABILITY(GL_DEBUG_OUTPUT_SYNCHRONOUS),
};
#undef CAPABILITY

enum class Source { get, query, uniform_block };

struct Value {
    GLenum name;
    const char* text;
    std::size_t count = 1;
    Source source = Source::get;
    GLuint index = 0;
};
#define VALUE(name_, ...)                        \
    Value {                                      \
        name_, #name_ __VA_OPT__(, ) __VA_ARGS__ \
    }
constexpr Value kValues[] = {
    VALUE(GL_DRAW_FRAMEBUFFER_BINDING),
    VALUE(GL_READ_FRAMEBUFFER_BINDING),
    VALUE(GL_VIEWPORT, 4),
    VALUE(GL_SCISSOR_BOX, 4),
    VALUE(GL_DEPTH_FUNC),
    VALUE(GL_DEPTH_WRITEMASK),
    VALUE(GL_DEPTH_RANGE, 2),
    VALUE(GL_DEPTH_CLEAR_VALUE),
    VALUE(GL_COLOR_CLEAR_VALUE, 4),
    VALUE(GL_STENCIL_CLEAR_VALUE),
    VALUE(GL_CLIP_ORIGIN),
    VALUE(GL_CLIP_DEPTH_MODE),
    VALUE(GL_BLEND_SRC_RGB),
    VALUE(GL_BLEND_DST_RGB),
    VALUE(GL_BLEND_SRC_ALPHA),
    VALUE(GL_BLEND_DST_ALPHA),
    VALUE(GL_BLEND_EQUATION_RGB),
    VALUE(GL_BLEND_EQUATION_ALPHA),
    VALUE(GL_BLEND_COLOR, 4),
    VALUE(GL_LOGIC_OP_MODE),
    VALUE(GL_COLOR_WRITEMASK, 4),
    VALUE(GL_CULL_FACE_MODE),
    VALUE(GL_FRONT_FACE),
    VALUE(GL_POLYGON_MODE),
    VALUE(GL_POLYGON_OFFSET_FACTOR),
    VALUE(GL_POLYGON_OFFSET_UNITS),
    VALUE(GL_LINE_WIDTH),
    VALUE(GL_POINT_SIZE),
    VALUE(GL_PROVOKING_VERTEX),
    VALUE(GL_PRIMITIVE_RESTART_INDEX),
    VALUE(GL_SAMPLE_COVERAGE_VALUE),
    VALUE(GL_SAMPLE_COVERAGE_INVERT),
    VALUE(GL_MIN_SAMPLE_SHADING_VALUE),
    VALUE(GL_STENCIL_FUNC),
    VALUE(GL_STENCIL_REF),
    VALUE(GL_STENCIL_VALUE_MASK),
    VALUE(GL_STENCIL_FAIL),
    VALUE(GL_STENCIL_PASS_DEPTH_FAIL),
    VALUE(GL_STENCIL_PASS_DEPTH_PASS),
    VALUE(GL_STENCIL_WRITEMASK),
    VALUE(GL_STENCIL_BACK_FUNC),
    VALUE(GL_STENCIL_BACK_REF),
    VALUE(GL_STENCIL_BACK_VALUE_MASK),
    VALUE(GL_STENCIL_BACK_FAIL),
    VALUE(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
    VALUE(GL_STENCIL_BACK_PASS_DEPTH_PASS),
    VALUE(GL_STENCIL_BACK_WRITEMASK),
    VALUE(GL_PACK_SWAP_BYTES),
    VALUE(GL_PACK_LSB_FIRST),
    VALUE(GL_PACK_ROW_LENGTH),
    VALUE(GL_PACK_IMAGE_HEIGHT),
    VALUE(GL_PACK_SKIP_ROWS),
    VALUE(GL_PACK_SKIP_PIXELS),
    VALUE(GL_PACK_SKIP_IMAGES),
    VALUE(GL_PACK_ALIGNMENT),
    VALUE(GL_UNPACK_SWAP_BYTES),
    VALUE(GL_UNPACK_LSB_FIRST),
    VALUE(GL_UNPACK_ROW_LENGTH),
    VALUE(GL_UNPACK_IMAGE_HEIGHT),
    VALUE(GL_UNPACK_SKIP_ROWS),
    VALUE(GL_UNPACK_SKIP_PIXELS),
    VALUE(GL_UNPACK_SKIP_IMAGES),
    VALUE(GL_UNPACK_ALIGNMENT),
    VALUE(GL_PIXEL_PACK_BUFFER_BINDING),
    VALUE(GL_PIXEL_UNPACK_BUFFER_BINDING),
    VALUE(GL_TRANSFORM_FEEDBACK_BINDING),
    VALUE(GL_TRANSFORM_FEEDBACK_ACTIVE),
    VALUE(GL_TRANSFORM_FEEDBACK_PAUSED),
    VALUE(GL_PRIMITIVES_GENERATED, 1, Source::query),
    VALUE(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, Source::query),
    VALUE(GL_SAMPLES_PASSED, 1, Source::query),
    VALUE(GL_ANY_SAMPLES_PASSED, 1, Source::query),
    VALUE(GL_TIME_ELAPSED, 1, Source::query),
    {GL_UNIFORM_BUFFER_BINDING, "uniform block Frame (binding 0)", 1, Source::uniform_block,
     kFrameBinding},
    {GL_UNIFORM_BUFFER_BINDING, "uniform block Frozen (binding 1)", 1, Source::uniform_block,
     kFrozenBinding},
};
#undef VALUE

std::vector<double> read(const Value& value) {
    // GL_POLYGON_MODE answers with two values in some drivers though core knows one.
    std::array<double, 4> values{};
    GLint integer = 0;
    switch (value.source) {
        case Source::get: glGetDoublev(value.name, values.data()); break;
        case Source::query:
            glGetQueryiv(value.name, GL_CURRENT_QUERY, &integer);
            values[0] = integer;
            break;
        case Source::uniform_block:
            glGetIntegeri_v(value.name, value.index, &integer);
            values[0] = integer;
            break;
    }
    return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(value.count)};
}

#define ENUMERANT(name_) \
    case name_: return #name_
/// The words of the values that methods change in practice; nullptr for the rest.
const char* enumerant(double value) {
    switch (static_cast<GLenum>(value)) {
        ENUMERANT(GL_NEVER);
        ENUMERANT(GL_LESS);
        ENUMERANT(GL_EQUAL);
        ENUMERANT(GL_LEQUAL);
        ENUMERANT(GL_GREATER);
        ENUMERANT(GL_NOTEQUAL);
        ENUMERANT(GL_GEQUAL);
        ENUMERANT(GL_ALWAYS);
        ENUMERANT(GL_FRONT);
        ENUMERANT(GL_BACK);
        ENUMERANT(GL_FRONT_AND_BACK);
        ENUMERANT(GL_CW);
        ENUMERANT(GL_CCW);
        ENUMERANT(GL_POINT);
        ENUMERANT(GL_LINE);
        ENUMERANT(GL_FILL);
        ENUMERANT(GL_LOWER_LEFT);
        ENUMERANT(GL_UPPER_LEFT);
        ENUMERANT(GL_NEGATIVE_ONE_TO_ONE);
        ENUMERANT(GL_ZERO_TO_ONE);
        ENUMERANT(GL_SRC_ALPHA);
        ENUMERANT(GL_ONE_MINUS_SRC_ALPHA);
        ENUMERANT(GL_FUNC_ADD);
        ENUMERANT(GL_FIRST_VERTEX_CONVENTION);
        ENUMERANT(GL_LAST_VERTEX_CONVENTION);
        default: return nullptr;
    }
}
#undef ENUMERANT

std::string in_words(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) {
        if (!text.empty()) text += " ";
        // No enumerant listed above is under 0x200; sizes and names that happen to equal one are
        // rare, and then the number stands beside the word.
        const char* name = value >= 0x200 && value < 0x10000 ? enumerant(value) : nullptr;
        text += name != nullptr ? fmt::format("{} ({})", name, value) : fmt::format("{}", value);
    }
    return text;
}

void set_enabled(GLenum capability, bool enabled) {
    if (enabled) {
        glEnable(capability);
    } else {
        glDisable(capability);
    }
}

}  // namespace

PipelineState PipelineState::capture() {
    PipelineState state;
    for (const Capability& capability : kCapabilities) {
        state.enabled_.push_back(glIsEnabled(capability.name) == GL_TRUE);
    }
    for (const Value& value : kValues) state.values_.push_back(read(value));
    return state;
}

std::vector<std::string> PipelineState::differences(const PipelineState& found) const {
    std::vector<std::string> result;
    const auto word = [](bool enabled) { return enabled ? "enabled" : "disabled"; };
    for (std::size_t i = 0; i < enabled_.size(); ++i) {
        if (enabled_[i] == found.enabled_[i]) continue;
        result.push_back(fmt::format("{}: expected {}, found {}", kCapabilities[i].text,
                                     word(enabled_[i]), word(found.enabled_[i])));
    }
    for (std::size_t i = 0; i < values_.size(); ++i) {
        if (values_[i] == found.values_[i]) continue;
        result.push_back(fmt::format("{}: expected {}, found {}", kValues[i].text,
                                     in_words(values_[i]), in_words(found.values_[i])));
    }
    return result;
}

void PipelineState::restore() const {
    const auto at = [this](GLenum name, std::size_t component = 0) {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (kValues[i].name == name) return values_[i][component];
        }
        return 0.0;
    };
    const auto integer = [&](GLenum name, std::size_t component = 0) {
        return static_cast<GLint>(at(name, component));
    };
    const auto word = [&](GLenum name) { return static_cast<GLenum>(at(name)); };
    const auto real = [&](GLenum name, std::size_t component = 0) {
        return static_cast<GLfloat>(at(name, component));
    };
    const auto flag = [&](GLenum name, std::size_t component = 0) {
        return static_cast<GLboolean>(at(name, component) != 0 ? GL_TRUE : GL_FALSE);
    };
    GLint active = 0;
    glGetIntegerv(GL_TRANSFORM_FEEDBACK_ACTIVE, &active);
    if (active != 0 && at(GL_TRANSFORM_FEEDBACK_ACTIVE) == 0) glEndTransformFeedback();
    for (std::size_t i = 0; i < values_.size(); ++i) {
        if (kValues[i].source == Source::uniform_block) {
            glBindBufferBase(GL_UNIFORM_BUFFER, kValues[i].index,
                             static_cast<GLuint>(values_[i][0]));
        } else if (kValues[i].source == Source::query) {
            glGetQueryiv(kValues[i].name, GL_CURRENT_QUERY, &active);
            if (active != 0 && values_[i][0] == 0) glEndQuery(kValues[i].name);
        }
    }
    for (std::size_t i = 0; i < enabled_.size(); ++i)
        set_enabled(kCapabilities[i].name, enabled_[i]);

    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, word(GL_DRAW_FRAMEBUFFER_BINDING));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, word(GL_READ_FRAMEBUFFER_BINDING));
    glViewportIndexedf(0, real(GL_VIEWPORT, 0), real(GL_VIEWPORT, 1), real(GL_VIEWPORT, 2),
                       real(GL_VIEWPORT, 3));
    glScissor(integer(GL_SCISSOR_BOX, 0), integer(GL_SCISSOR_BOX, 1), integer(GL_SCISSOR_BOX, 2),
              integer(GL_SCISSOR_BOX, 3));
    glDepthFunc(word(GL_DEPTH_FUNC));
    glDepthMask(flag(GL_DEPTH_WRITEMASK));
    glDepthRange(at(GL_DEPTH_RANGE, 0), at(GL_DEPTH_RANGE, 1));
    glClearDepth(at(GL_DEPTH_CLEAR_VALUE));
    glClearColor(real(GL_COLOR_CLEAR_VALUE, 0), real(GL_COLOR_CLEAR_VALUE, 1),
                 real(GL_COLOR_CLEAR_VALUE, 2), real(GL_COLOR_CLEAR_VALUE, 3));
    glClearStencil(integer(GL_STENCIL_CLEAR_VALUE));
    glClipControl(word(GL_CLIP_ORIGIN), word(GL_CLIP_DEPTH_MODE));
    glBlendFuncSeparate(word(GL_BLEND_SRC_RGB), word(GL_BLEND_DST_RGB), word(GL_BLEND_SRC_ALPHA),
                        word(GL_BLEND_DST_ALPHA));
    glBlendEquationSeparate(word(GL_BLEND_EQUATION_RGB), word(GL_BLEND_EQUATION_ALPHA));
    glBlendColor(real(GL_BLEND_COLOR, 0), real(GL_BLEND_COLOR, 1), real(GL_BLEND_COLOR, 2),
                 real(GL_BLEND_COLOR, 3));
    glLogicOp(word(GL_LOGIC_OP_MODE));
    glColorMask(flag(GL_COLOR_WRITEMASK, 0), flag(GL_COLOR_WRITEMASK, 1),
                flag(GL_COLOR_WRITEMASK, 2), flag(GL_COLOR_WRITEMASK, 3));
    glCullFace(word(GL_CULL_FACE_MODE));
    glFrontFace(word(GL_FRONT_FACE));
    glPolygonMode(GL_FRONT_AND_BACK, word(GL_POLYGON_MODE));
    glPolygonOffset(real(GL_POLYGON_OFFSET_FACTOR), real(GL_POLYGON_OFFSET_UNITS));
    glLineWidth(real(GL_LINE_WIDTH));
    glPointSize(real(GL_POINT_SIZE));
    glProvokingVertex(word(GL_PROVOKING_VERTEX));
    glPrimitiveRestartIndex(word(GL_PRIMITIVE_RESTART_INDEX));
    glSampleCoverage(real(GL_SAMPLE_COVERAGE_VALUE), flag(GL_SAMPLE_COVERAGE_INVERT));
    glMinSampleShading(real(GL_MIN_SAMPLE_SHADING_VALUE));
    glStencilFuncSeparate(GL_FRONT, word(GL_STENCIL_FUNC), integer(GL_STENCIL_REF),
                          word(GL_STENCIL_VALUE_MASK));
    glStencilOpSeparate(GL_FRONT, word(GL_STENCIL_FAIL), word(GL_STENCIL_PASS_DEPTH_FAIL),
                        word(GL_STENCIL_PASS_DEPTH_PASS));
    glStencilMaskSeparate(GL_FRONT, word(GL_STENCIL_WRITEMASK));
    glStencilFuncSeparate(GL_BACK, word(GL_STENCIL_BACK_FUNC), integer(GL_STENCIL_BACK_REF),
                          word(GL_STENCIL_BACK_VALUE_MASK));
    glStencilOpSeparate(GL_BACK, word(GL_STENCIL_BACK_FAIL), word(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
                        word(GL_STENCIL_BACK_PASS_DEPTH_PASS));
    glStencilMaskSeparate(GL_BACK, word(GL_STENCIL_BACK_WRITEMASK));
    for (const Value& value : kValues) {
        const bool store =
            (value.name >= GL_UNPACK_SWAP_BYTES && value.name <= GL_UNPACK_ALIGNMENT) ||
            (value.name >= GL_PACK_SWAP_BYTES && value.name <= GL_PACK_ALIGNMENT) ||
            (value.name >= GL_PACK_SKIP_IMAGES && value.name <= GL_UNPACK_IMAGE_HEIGHT);
        if (store) glPixelStorei(value.name, integer(value.name));
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, word(GL_PIXEL_PACK_BUFFER_BINDING));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, word(GL_PIXEL_UNPACK_BUFFER_BINDING));
    if (at(GL_TRANSFORM_FEEDBACK_ACTIVE) == 0) {
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, word(GL_TRANSFORM_FEEDBACK_BINDING));
    }
}

}  // namespace lodbench::gl
