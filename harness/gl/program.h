#pragma once
// Programs from GLSL text with includes; always able to feed back gl_Position.

#include <GL/glcorearb.h>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/objects.h"

namespace lodbench::gl {

/// A shader file that the build embedded.
struct ShaderSource {
    const char* name;  ///< what `#include` names: "common/terrain.glsl", "pgm.vert"
    const char* text;
};

/// The shaders of shaders/common, embedded in the library.
[[nodiscard]] std::span<const ShaderSource> common_shaders();

/// One stage of a program: GL_VERTEX_SHADER, ... and the name of its source.
struct Stage {
    GLenum type;
    const char* source;
};

/// Replaces each line `#include "NAME"` by the file of that name, once per text, keeping compiler
/// messages right with #line (the file's index is its place in `files`). `own` is searched before
/// the common shaders. Throws ContractError for a missing file or a cycle, naming file and line.
struct Expanded {
    std::string text;
    std::vector<std::string> files;
};
[[nodiscard]] Expanded expand_includes(std::string_view name, std::span<const ShaderSource> own);

/// A compiler's log in one line, with the names of the files in place of their numbers; understands
/// the forms of Mesa ("0:12(5): ..."), NVIDIA ("0(12) : ...") and AMD ("ERROR: 0:12: ...").
[[nodiscard]] std::string name_files(std::string_view log, std::span<const std::string> files);

class Program : public Object {
public:
    Program() = default;
    /// Compiles and links; all but compute programs feed back gl_Position. Each of `defines`
    /// becomes "#define NAME VALUE" after the #version line. Throws ContractError with the
    /// compiler's words, file names instead of numbers.
    Program(Device& device, std::string_view label, std::span<const ShaderSource> own,
            std::initializer_list<Stage> stages,
            const std::map<std::string, std::string>& defines = {});
    Program(Program&& other) noexcept;
    Program& operator=(Program&& other) noexcept;
    ~Program();

    // Uniforms by name; a name that the linker has removed is passed over in silence, a name that
    // no source file contains is a ContractError.
    void set(std::string_view name, int value);
    void set(std::string_view name, unsigned value);
    void set(std::string_view name, float value);
    void set(std::string_view name, const glm::vec2& value);
    void set(std::string_view name, const glm::vec3& value);
    void set(std::string_view name, const glm::vec4& value);
    void set(std::string_view name, const glm::ivec2& value);
    void set(std::string_view name, const glm::ivec4& value);
    void set(std::string_view name, const glm::mat4& value);
    void set(std::string_view name, const glm::mat3& value);

private:
    struct Linked {
        GLuint name = 0;
        std::string sources;
    };
    Program(Device& device, std::string_view label, Linked linked);
    static Linked link(std::string_view label, std::span<const ShaderSource> own,
                       std::initializer_list<Stage> stages,
                       const std::map<std::string, std::string>& defines);
    [[nodiscard]] GLint location(std::string_view name);
    std::map<std::string, GLint, std::less<>> locations_;
    std::string
        sources_;  ///< all stages' expanded text, to tell a removed uniform from a misspelt one
};

}  // namespace lodbench::gl
