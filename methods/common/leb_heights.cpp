#include "common/leb_heights.h"

#include <algorithm>
#include <vector>

namespace lodbench::common {

LebHeights::LebHeights(gl::Device& device, std::string_view label, const LebGrid& grid, int rows,
                       int columns) {
    const int limit = device.info().max_texture_size;
    const bool in_buffer = columns > limit || rows > limit;
    if (in_buffer) {
        buffer_ =
            gl::Buffer(device, label, std::size_t(rows) * std::size_t(columns) * sizeof(float));
    } else {
        texture_ = gl::Texture(device, label, GL_TEXTURE_2D, GL_R32F, columns, rows);
        texture_.set_parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        texture_.set_parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    constexpr int kBand = 64;
    std::vector<float> band(std::size_t(kBand) * std::size_t(columns));
    for (int first = 0; first < rows; first += kBand) {
        const int count = std::min(kBand, rows - first);
        float* out = band.data();
        for (int row = first; row < first + count; ++row) {
            const LebVertex* vertex = &grid.at({row, 0});
            for (int column = 0; column < columns; ++column) *out++ = vertex[column].height;
        }
        if (in_buffer) {
            const std::size_t offset = std::size_t(first) * std::size_t(columns) * sizeof(float);
            buffer_.write(offset, std::size_t(out - band.data()) * sizeof(float), band.data());
        } else {
            texture_.write(0, 0, first, columns, count, GL_RED, GL_FLOAT, band.data());
        }
    }
}

std::map<std::string, std::string> LebHeights::defines() const {
    if (buffer_) return {{"HEIGHTS_IN_BUFFER", "1"}};
    return {};
}

void LebHeights::bind() const {
    if (buffer_) {
        buffer_.bind_storage(kBinding);
    } else {
        texture_.bind(kTextureUnit);
    }
}

}  // namespace lodbench::common
