#include "gl/program.h"

#include <fmt/format.h>

#include <cctype>
#include <glm/gtc/type_ptr.hpp>

#include "api/error.h"
#include "gl/device.h"

namespace lodbench::gl {

namespace {

/// Owns shader names while a program is made of them.
class Shaders {
public:
    Shaders() = default;
    Shaders(const Shaders&) = delete;
    Shaders& operator=(const Shaders&) = delete;
    ~Shaders() {
        for (const GLuint shader : names_) glDeleteShader(shader);
    }
    GLuint add(GLenum type) {
        names_.push_back(glCreateShader(type));
        return names_.back();
    }
    [[nodiscard]] const std::vector<GLuint>& names() const { return names_; }

private:
    std::vector<GLuint> names_;
};

/// Puts the defines behind the #version line, which must come first but for comments and empty
/// lines.
std::string with_defines(const std::string& text, const std::map<std::string, std::string>& defines,
                         const std::string& file) {
    std::size_t begin = text.find("#version");
    while (begin != std::string::npos && begin != 0 && text[begin - 1] != '\n') {
        begin = text.find("#version", begin + 1);
    }
    if (begin == std::string::npos) {
        throw ContractError(
            fmt::format("{}: no #version line; expected \"#version 450 core\" first", file));
    }
    const std::size_t end = text.find('\n', begin);
    int line = 2;
    for (std::size_t i = 0; i < begin; ++i) line += text[i] == '\n' ? 1 : 0;
    std::string result = text.substr(0, end) + "\n";
    for (const auto& [name, value] : defines) result += fmt::format("#define {} {}\n", name, value);
    result += fmt::format("#line {} 0\n", line);
    if (end != std::string::npos) result += text.substr(end + 1);
    return result;
}

std::string shader_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    if (length > 0) glGetShaderInfoLog(shader, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

std::string program_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    if (length > 0) glGetProgramInfoLog(program, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

bool contains_word(std::string_view text, std::string_view word) {
    const auto in_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    };
    for (std::size_t at = text.find(word); at != std::string_view::npos;
         at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        if ((at == 0 || !in_word(text[at - 1])) && (end == text.size() || !in_word(text[end])))
            return true;
    }
    return false;
}

}  // namespace

Program::Linked Program::link(std::string_view label, std::span<const ShaderSource> own,
                              std::initializer_list<Stage> stages,
                              const std::map<std::string, std::string>& defines) {
    std::string sources;
    Shaders shaders;
    bool compute = false;
    for (const Stage& stage : stages) {
        const Expanded expanded = expand_includes(stage.source, own);
        const std::string text = with_defines(expanded.text, defines, stage.source);
        const GLuint shader = shaders.add(stage.type);
        const char* pointer = text.c_str();
        glShaderSource(shader, 1, &pointer, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        if (compiled == GL_FALSE) {
            throw ContractError(fmt::format("program '{}': {} does not compile: {}", label,
                                            stage.source,
                                            name_files(shader_log(shader), expanded.files)));
        }
        compute = compute || stage.type == GL_COMPUTE_SHADER;
        sources += text;
    }
    const GLuint program = glCreateProgram();
    for (const GLuint shader : shaders.names()) glAttachShader(program, shader);
    if (!compute) {
        const char* position = "gl_Position";
        glTransformFeedbackVaryings(program, 1, &position, GL_INTERLEAVED_ATTRIBS);
    }
    glLinkProgram(program);
    for (const GLuint shader : shaders.names()) glDetachShader(program, shader);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) {
        const std::string log = name_files(program_log(program), {});
        glDeleteProgram(program);
        throw ContractError(fmt::format("program '{}' does not link: {}", label, log));
    }
    return {program, std::move(sources)};
}

Program::Program(Device& device, std::string_view label, std::span<const ShaderSource> own,
                 std::initializer_list<Stage> stages,
                 const std::map<std::string, std::string>& defines)
    : Program(device, label, link(label, own, stages, defines)) {}

Program::Program(Device& device, std::string_view label, Linked linked)
    : Object(device, GL_PROGRAM, linked.name, label), sources_(std::move(linked.sources)) {
    ++device.object_counts().programs;
}

Program::Program(Program&& other) noexcept
    : Object(std::move(other)),
      locations_(std::move(other.locations_)),
      sources_(std::move(other.sources_)) {}

Program& Program::operator=(Program&& other) noexcept {
    Program taken(std::move(other));
    swap(taken);
    locations_.swap(taken.locations_);
    sources_.swap(taken.sources_);
    return *this;
}

Program::~Program() {
    if (name_ == 0) return;
    glDeleteProgram(name_);
    --device_->object_counts().programs;
}

GLint Program::location(std::string_view name) {
    const auto known = locations_.find(name);
    if (known != locations_.end()) return known->second;
    const std::string text(name);
    const GLint found = glGetUniformLocation(name_, text.c_str());
    if (found < 0 && !contains_word(sources_, name.substr(0, name.find_first_of("[.")))) {
        throw ContractError(
            fmt::format("program '{}' has no uniform '{}' in any of its sources", label_, name));
    }
    locations_.emplace(text, found);
    return found;
}

// A location of -1 is passed over by OpenGL itself.
void Program::set(std::string_view name, int value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform1i(name_, location(name), value);
}

void Program::set(std::string_view name, unsigned value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform1ui(name_, location(name), value);
}

void Program::set(std::string_view name, float value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform1f(name_, location(name), value);
}

void Program::set(std::string_view name, const glm::vec2& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform2fv(name_, location(name), 1, glm::value_ptr(value));
}

void Program::set(std::string_view name, const glm::vec3& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform3fv(name_, location(name), 1, glm::value_ptr(value));
}

void Program::set(std::string_view name, const glm::vec4& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform4fv(name_, location(name), 1, glm::value_ptr(value));
}

void Program::set(std::string_view name, const glm::ivec2& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform2iv(name_, location(name), 1, glm::value_ptr(value));
}

void Program::set(std::string_view name, const glm::ivec4& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniform4iv(name_, location(name), 1, glm::value_ptr(value));
}

void Program::set(std::string_view name, const glm::mat4& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniformMatrix4fv(name_, location(name), 1, GL_FALSE, glm::value_ptr(value));
}

void Program::set(std::string_view name, const glm::mat3& value) {
    const Device::Scope scope(*device_, this);
    glProgramUniformMatrix3fv(name_, location(name), 1, GL_FALSE, glm::value_ptr(value));
}

}  // namespace lodbench::gl
