#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "api/error.h"
#include "gl/program.h"

namespace lodbench::gl {

namespace {

const ShaderSource* find_source(std::string_view name, std::span<const ShaderSource> own) {
    for (const std::span<const ShaderSource> sources : {own, common_shaders()}) {
        for (const ShaderSource& source : sources) {
            if (name == source.name) return &source;
        }
    }
    return nullptr;
}

std::string_view trimmed_front(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    return begin == std::string_view::npos ? std::string_view() : text.substr(begin);
}

/// The name in `#include "NAME"`; nothing for any other line.
std::optional<std::string_view> included_name(std::string_view line) {
    line = trimmed_front(line);
    if (line.empty() || line.front() != '#') return std::nullopt;
    line = trimmed_front(line.substr(1));
    constexpr std::string_view kInclude = "include";
    if (!line.starts_with(kInclude)) return std::nullopt;
    line = trimmed_front(line.substr(kInclude.size()));
    const std::size_t end =
        line.size() > 1 && line.front() == '"' ? line.find('"', 1) : std::string_view::npos;
    return end == std::string_view::npos ? std::string_view() : line.substr(1, end - 1);
}

class Expander {
public:
    explicit Expander(std::span<const ShaderSource> own) : own_(own) {}

    void expand(const ShaderSource& source) {
        const std::string file = source.name;
        const std::size_t index = result_.files.size();
        result_.files.push_back(file);
        open_.push_back(file);
        std::string_view rest = source.text;
        for (int line_number = 1; !rest.empty(); ++line_number) {
            const std::size_t end = rest.find('\n');
            const std::string_view line = rest.substr(0, end);
            rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
            const auto name = included_name(line);
            if (!name) {
                result_.text.append(line).push_back('\n');
                continue;
            }
            include(*name, file, line_number);
            result_.text += fmt::format("#line {} {}\n", line_number + 1, index);
        }
        open_.pop_back();
    }

    Expanded take() { return std::move(result_); }

private:
    void include(std::string_view name, const std::string& file, int line_number) {
        const ShaderSource* source = find_source(name, own_);
        if (source == nullptr) {
            throw ContractError(
                fmt::format("{}:{}: #include \"{}\": no such shader; name it in SHADERS of "
                            "lodbench_add_method, or include one of "
                            "shaders/common",
                            file, line_number, name));
        }
        if (std::find(open_.begin(), open_.end(), name) != open_.end()) {
            std::string chain;
            for (const std::string& open : open_) chain += open + " -> ";
            throw ContractError(fmt::format("{}:{}: #include \"{}\" closes a cycle: {}{}", file,
                                            line_number, name, chain, name));
        }
        if (std::find(result_.files.begin(), result_.files.end(), name) != result_.files.end())
            return;
        result_.text += fmt::format("#line 1 {}\n", result_.files.size());
        expand(*source);
    }

    std::span<const ShaderSource> own_;
    std::vector<std::string> open_;
    Expanded result_;
};

}  // namespace

Expanded expand_includes(std::string_view name, std::span<const ShaderSource> own) {
    const ShaderSource* source = find_source(name, own);
    if (source == nullptr) {
        throw ContractError(fmt::format(
            "shader '{}' is not embedded; name it in SHADERS of lodbench_add_method", name));
    }
    Expander expander(own);
    expander.expand(*source);
    return expander.take();
}

std::string name_files(std::string_view log, std::span<const std::string> files) {
    std::string result;
    while (!log.empty()) {
        const std::size_t end = log.find('\n');
        std::string_view line = log.substr(0, end);
        log = end == std::string_view::npos ? std::string_view() : log.substr(end + 1);
        while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0)
            line.remove_suffix(1);
        if (line.empty() || line == std::string_view("\0", 1)) continue;
        if (!result.empty()) result += "; ";
        // "0:12(5): error", "0(12) : error", "ERROR: 0:12: ...": the first number is the file's
        // index.
        const std::size_t prefix = line.starts_with("ERROR: ")     ? 7
                                   : line.starts_with("WARNING: ") ? 9
                                                                   : 0;
        std::size_t digits = prefix;
        std::size_t index = 0;
        while (digits < line.size() && digits < prefix + 6 && line[digits] >= '0' &&
               line[digits] <= '9') {
            index = index * 10 + static_cast<std::size_t>(line[digits++] - '0');
        }
        const bool located = digits > prefix && digits + 1 < line.size() &&
                             (line[digits] == ':' || line[digits] == '(') &&
                             line[digits + 1] >= '0' && line[digits + 1] <= '9';
        if (located && index < files.size()) {
            result +=
                fmt::format("{}{}{}", line.substr(0, prefix), files[index], line.substr(digits));
        } else {
            result += line;
        }
    }
    return result;
}

}  // namespace lodbench::gl
