#include "multi_context/errors_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "api/error.h"
#include "gl/frame_blocks.h"
#include "multi_context/errors_shaders.h"

namespace lodbench::multi_context {

namespace {

constexpr GLuint kBlockErrorsBinding = 2;   // of block_errors.comp
constexpr GLuint kListedBlocksBinding = 3;  // likewise
constexpr int kWorkGroup = 8;               // a side, of errors.comp

gl::Program compute_program(gl::Device& device, const char* label, const char* source, bool bytes,
                            bool listed = false) {
    std::map<std::string, std::string> defines;
    if (bytes) defines["MULTI_CONTEXT_BYTES"] = "1";
    if (listed) defines["MULTI_CONTEXT_LIST"] = "1";
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
                                     settings.bytes, settings.read_back == ReadBack::tree)),
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
    if (layout_.count() == 0) return;  // a single block at full resolution
    std::size_t bytes = errors_.bytes();
    if (settings.read_back != ReadBack::whole) {
        // Of a tree one LOD at a time, of which the finest has the most blocks.
        const std::size_t finest =
            std::size_t(layout_.blocks_along(1)) * std::size_t(layout_.blocks_along(1));
        const bool tree = settings.read_back == ReadBack::tree;
        bytes = (tree ? finest : layout_.count()) * sizeof(float);
        block_errors_ = gl::Buffer(device, "multi-context: block errors", bytes, 0);
        if (tree) {
            listed_blocks_ =
                gl::Buffer(device, "multi-context: blocks to gather", finest * sizeof(glm::ivec2));
        }
    }
    constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    read_back_ =
        gl::Buffer(device, "multi-context: read-back", bytes, kMapping | GL_CLIENT_STORAGE_BIT);
    mapped_ = glMapNamedBufferRange(read_back_.name(), 0, GLsizeiptr(bytes), kMapping);
    if (mapped_ == nullptr) {
        throw EnvironmentError(
            fmt::format("multi-context: the driver maps no buffer of {} bytes "
                        "for reading",
                        bytes));
    }
}

void ErrorsPass::run(const Camera& camera, BlockErrors& errors, const BetweenParts& between) {
    begin(camera);
    for (int level = 1; level <= layout_.n(); ++level) evaluate_level(level);
    read_back(errors, between);
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

void ErrorsPass::read_back(BlockErrors& errors, const BetweenParts& between) {
    errors.layout = layout_;
    errors.delta = settings_.delta;
    errors.read_back_bytes = 0;
    if (!read_back_) return;
    switch (settings_.read_back) {
        case ReadBack::whole: read_whole(errors, between); break;
        case ReadBack::blocks: read_blocks(errors, between); break;
        case ReadBack::tree: read_tree(errors); break;
    }
}

void ErrorsPass::wait_until_arrived() {
    gl::Fence(device_).wait();
}

void ErrorsPass::read_whole(BlockErrors& errors, const BetweenParts& between) {
    const int samples = layout_.samples();
    const std::size_t texel = settings_.bytes ? 1 : sizeof(float);
    const std::size_t line = texel * std::size_t(samples);
    const auto bring = [&](auto& destination) {
        destination.resize(std::size_t(samples) * std::size_t(samples));
        auto* const bytes = reinterpret_cast<std::byte*>(destination.data());
        for (int part = 0; part < settings_.parts; ++part) {
            const int first = int(std::int64_t(samples) * part / settings_.parts);
            const int rows = int(std::int64_t(samples) * (part + 1) / settings_.parts) - first;
            if (part > 0) between();
            if (rows == 0) continue;
            glPixelStorei(GL_PACK_ALIGNMENT, 1);
            glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_.name());
            glGetTextureSubImage(errors_.name(), 0, 0, first, 0, samples, rows, 1,
                                 settings_.bytes ? GL_RED_INTEGER : GL_RED,
                                 settings_.bytes ? GL_UNSIGNED_BYTE : GL_FLOAT,
                                 GLsizei(read_back_.bytes()), nullptr);
            glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
            wait_until_arrived();
            std::memcpy(bytes + line * std::size_t(first), mapped_, line * std::size_t(rows));
        }
        errors.read_back_bytes = line * std::size_t(samples);
    };
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
    if (settings_.bytes) {
        bring(errors.codes);
    } else {
        bring(errors.texels);
    }
}

void ErrorsPass::start_gathering(int lod) {
    glBindImageTexture(0, errors_.name(), 0, GL_FALSE, 0, GL_READ_ONLY, errors_.internal_format());
    block_errors_.bind_storage(kBlockErrorsBinding);
    block_program_.set("block_cells", layout_.block_cells());
    block_program_.set("delta", settings_.delta);
    block_program_.set("lod", lod);
}

void ErrorsPass::gather_every_block() {
    for (int lod = 1; lod <= layout_.coarsest(); ++lod) {
        start_gathering(lod);
        block_program_.set("first_block", int(layout_.first(lod)));
        const auto blocks = GLuint(layout_.blocks_along(lod));
        device_.dispatch_compute(block_program_, blocks, blocks, 1);
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ErrorsPass::read_blocks(BlockErrors& errors, const BetweenParts& between) {
    gather_every_block();
    errors.blocks.resize(layout_.count());
    for (int part = 0; part < settings_.parts; ++part) {
        const std::size_t first =
            layout_.count() * std::size_t(part) / std::size_t(settings_.parts);
        const std::size_t end =
            layout_.count() * std::size_t(part + 1) / std::size_t(settings_.parts);
        if (part > 0) between();
        if (first == end) continue;
        const std::size_t bytes = (end - first) * sizeof(float);
        glCopyNamedBufferSubData(block_errors_.name(), read_back_.name(),
                                 GLintptr(first * sizeof(float)), 0, GLsizeiptr(bytes));
        wait_until_arrived();
        std::memcpy(errors.blocks.data() + first, mapped_, bytes);
    }
    errors.read_back_bytes = layout_.count() * sizeof(float);
}

void ErrorsPass::gather(int lod, std::span<const glm::ivec2> blocks) {
    constexpr std::size_t kMostAcross = 32768;  // work groups; OpenGL allows 65535 at least
    const std::size_t across = std::min(blocks.size(), kMostAcross);
    listed_blocks_.write(blocks);
    start_gathering(lod);
    listed_blocks_.bind_storage(kListedBlocksBinding);
    block_program_.set("block_count", int(blocks.size()));
    device_.dispatch_compute(block_program_, GLuint(across),
                             GLuint((blocks.size() + across - 1) / across), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glCopyNamedBufferSubData(block_errors_.name(), read_back_.name(), 0, 0,
                             GLsizeiptr(blocks.size() * sizeof(float)));
    wait_until_arrived();
}

// Breadth first, so that the round trips to the GPU are as many as LODs. Nothing is left out for
// being out of view: the errors outlive the camera that they are for.
void ErrorsPass::read_tree(BlockErrors& errors) {
    errors.blocks.assign(layout_.count(), kUnbounded);
    std::vector<glm::ivec2> blocks = {{0, 0}};  // column, row
    std::vector<glm::ivec2> children;
    for (int lod = layout_.coarsest(); lod >= 1 && !blocks.empty(); --lod) {
        gather(lod, blocks);
        errors.read_back_bytes += blocks.size() * sizeof(float);
        const auto* const found = static_cast<const float*>(mapped_);
        children.clear();
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            const glm::ivec2 block = blocks[i];
            errors.blocks[layout_.index(lod, block.y, block.x)] = found[i];
            if (found[i] <= settings_.delta) continue;
            for (const glm::ivec2 quadrant : {glm::ivec2{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
                children.push_back(2 * block + quadrant);
            }
        }
        std::swap(blocks, children);
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
