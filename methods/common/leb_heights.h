#pragma once
// The heights of a LebGrid on the GPU, without its padding: a texture, or a buffer where the
// terrain exceeds the largest texture.

#include <map>
#include <string>
#include <string_view>

#include "common/leb_grid.h"
#include "gl/device.h"
#include "gl/objects.h"

namespace lodbench::common {

class LebHeights {
public:
    /// Where a shader finds them: `sampler2D` at this texture unit, or, where HEIGHTS_IN_BUFFER is
    /// defined, an array of floats in the storage buffer at this binding, `columns` to a row.
    static constexpr GLuint kTextureUnit = 0;
    static constexpr GLuint kBinding = gl::kFirstFreeBinding;

    LebHeights() = default;
    /// Uploads rows x columns heights from the grid's north-west corner, in bands: no second copy
    /// of the terrain is made. Throws EnvironmentError where the driver has no memory.
    LebHeights(gl::Device& device, std::string_view label, const LebGrid& grid, int rows,
               int columns);

    /// For gl::Program.
    [[nodiscard]] std::map<std::string, std::string> defines() const;
    void bind() const;

private:
    gl::Texture texture_;
    gl::Buffer buffer_;  ///< instead of the texture
};

}  // namespace lodbench::common
