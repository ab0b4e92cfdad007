#include "multi_context/errors_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "api/error.h"
#include "gl/frame_blocks.h"
#include "multi_context/errors_shaders.h"

namespace lodbench::multi_context {

namespace {

constexpr GLuint kBlockErrorsBinding = 2;  // of block_errors.comp
constexpr int kWorkGroup = 8;              // a side, of errors.comp

gl::Program compute_program(gl::Device& device, const char* label, const char* source, bool bytes) {
    std::map<std::string, std::string> defines;
    if (bytes) defines["MULTI_CONTEXT_BYTES"] = "1";
    return {device, label, errors_shaders(), {{GL_COMPUTE_SHADER, source}}, defines};
}

}  // namespace

ErrorsPass::ErrorsPass(gl::Device& device, const gl::Texture& heights, const TerrainInfo& terrain,
                       const ErrorsSettings& settings)
    : device_(device),
      heights_(heights),
      terrain_(terrain),
      settings_(settings),
      layout_(terrain.rows, terrain.columns, settings.k),
      group_program_(
          compute_program(device, "multi-context: group errors", "errors.comp", settings.bytes)),
      block_program_(compute_program(device, "multi-context: block errors", "block_errors.comp",
                                     settings.bytes)),
      camera_block_(device, "multi-context: the errors' camera", sizeof(gl::Frozen)) {
    const int samples = layout_.samples();
    errors_ = gl::Texture(device, "multi-context: errors", GL_TEXTURE_2D,
                          settings.bytes ? GL_R8UI : GL_R32F, samples, samples);
    // Where no group has its centre the texture stays as it is now.
    const std::uint32_t zero = 0;
    if (settings.bytes) {
        glClearTexImage(errors_.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &zero);
    } else {
        glClearTexImage(errors_.name(), 0, GL_RED, GL_FLOAT, &zero);
    }
    const std::size_t blocks_bytes = layout_.count() * sizeof(float);
    if (!settings.whole && blocks_bytes > 0) {
        block_errors_ = gl::Buffer(device, "multi-context: block errors", blocks_bytes, 0);
    }
    read_back_bytes_ = settings.whole ? errors_.bytes() : blocks_bytes;
    if (read_back_bytes_ == 0) return;  // a single block at full resolution
    constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    read_back_ = gl::Buffer(device, "multi-context: read-back", read_back_bytes_,
                            kMapping | GL_CLIENT_STORAGE_BIT);
    mapped_ = glMapNamedBufferRange(read_back_.name(), 0, GLsizeiptr(read_back_bytes_), kMapping);
    if (mapped_ == nullptr) {
        throw EnvironmentError(
            fmt::format("multi-context: the driver maps no buffer of {} bytes "
                        "for reading",
                        read_back_bytes_));
    }
}

void ErrorsPass::run(const Camera& camera, BlockErrors& errors) {
    begin(camera);
    for (int level = 1; level <= layout_.n(); ++level) evaluate_level(level);
    start_read_back();
    finish_read_back(errors);
}

void ErrorsPass::begin(const Camera& camera) {
    const gl::Frozen block = gl::make_frozen(camera, terrain_);
    camera_block_.write(0, sizeof block, &block);
}

void ErrorsPass::evaluate_level(int level) {
    const int groups = layout_.groups_along(level);
    camera_block_.bind_uniform(gl::kFrozenBinding);
    heights_.bind(0);
    glBindImageTexture(0, errors_.name(), 0, GL_FALSE, 0, GL_READ_WRITE, errors_.internal_format());
    group_program_.set("level", level);
    group_program_.set("groups", groups);
    group_program_.set("delta", settings_.delta);
    const auto work_groups = GLuint((groups + kWorkGroup - 1) / kWorkGroup);
    device_.dispatch_compute(group_program_, work_groups, work_groups, 1);
    glMemoryBarrier(
        GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // the next level reads what this one wrote
}

void ErrorsPass::gather_blocks() {
    glBindImageTexture(0, errors_.name(), 0, GL_FALSE, 0, GL_READ_ONLY, errors_.internal_format());
    block_errors_.bind_storage(kBlockErrorsBinding);
    block_program_.set("block_cells", layout_.block_cells());
    block_program_.set("delta", settings_.delta);
    for (int lod = 1; lod <= layout_.coarsest(); ++lod) {
        block_program_.set("lod", lod);
        block_program_.set("first_block", int(layout_.first(lod)));
        const auto blocks = GLuint(layout_.blocks_along(lod));
        device_.dispatch_compute(block_program_, blocks, blocks, 1);
    }
}

void ErrorsPass::start_read_back() {
    if (read_back_bytes_ == 0) return;
    if (settings_.whole) {
        glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_.name());
        glGetTextureImage(errors_.name(), 0, settings_.bytes ? GL_RED_INTEGER : GL_RED,
                          settings_.bytes ? GL_UNSIGNED_BYTE : GL_FLOAT, GLsizei(read_back_bytes_),
                          nullptr);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    } else {
        gather_blocks();
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glCopyNamedBufferSubData(block_errors_.name(), read_back_.name(), 0, 0,
                                 GLsizeiptr(read_back_bytes_));
    }
    arrived_ = gl::Fence(device_);
}

void ErrorsPass::finish_read_back(BlockErrors& errors) {
    errors.layout = layout_;
    errors.delta = settings_.delta;
    if (read_back_bytes_ == 0) return;
    arrived_.wait();
    arrived_ = {};
    const auto copy_to = [&](auto& destination) {
        destination.resize(read_back_bytes_ / sizeof destination[0]);
        std::memcpy(destination.data(), mapped_, read_back_bytes_);
    };
    if (!settings_.whole) {
        copy_to(errors.blocks);
    } else if (settings_.bytes) {
        copy_to(errors.codes);
    } else {
        copy_to(errors.texels);
    }
}

std::vector<float> ErrorsPass::read_texture() const {
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    const std::size_t count = std::size_t(layout_.samples()) * std::size_t(layout_.samples());
    std::vector<float> texels(count);
    if (!settings_.bytes) {
        glGetTextureImage(errors_.name(), 0, GL_RED, GL_FLOAT, GLsizei(count * sizeof(float)),
                          texels.data());
        return texels;
    }
    std::vector<std::uint8_t> codes(count);
    glGetTextureImage(errors_.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, GLsizei(count),
                      codes.data());
    std::transform(codes.begin(), codes.end(), texels.begin(),
                   [&](std::uint8_t code) { return decode_error(code, settings_.delta); });
    return texels;
}

}  // namespace lodbench::multi_context
