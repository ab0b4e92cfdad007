#include "terrain/toml_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "api/error.h"
#include "base/printable.h"

namespace lodbench::terrain {
namespace {

/// Walks over the text once, keeping apart strings, comments and the rest, and refuses what is
/// longer or deeper than the caps. It knows no more of TOML than that: what is wrong otherwise, the
/// parser says.
class Guard {
public:
    Guard(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file) {}

    void check() {
        if (text_.size() > kTomlMaxBytes) {
            throw InputError(fmt::format("{}: {} bytes of TOML, the most that is read is {}",
                                         file_.string(), text_.size(), kTomlMaxBytes));
        }
        check_lines();
        while (at_ < text_.size()) step();
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, what));
    }

    void check_lines() {
        for (std::size_t begin = 0; begin <= text_.size(); ++line_) {
            const std::size_t end = std::min(text_.find('\n', begin), text_.size());
            if (end - begin > kTomlMaxLineBytes) {
                refuse(
                    fmt::format("a line of {} bytes, the longest that is read has {}; break it up",
                                end - begin, kTomlMaxLineBytes));
            }
            begin = end + 1;
        }
        line_ = 1;
    }

    void step() {
        switch (const char c = text_[at_]; c) {
            case '\n':
                ++line_;
                key_dots_ = 0;
                break;
            case '#': at_ = std::min(text_.find('\n', at_), text_.size()); return;
            case '"':
            case '\'': skip_string(c); return;
            case '[':
            case '{':
                key_dots_ = 0;
                if (++depth_ > kTomlMaxDepth) {
                    refuse(fmt::format("brackets nested more than {} deep", kTomlMaxDepth));
                }
                break;
            case ']':
            case '}':
                key_dots_ = 0;
                depth_ = std::max(depth_ - 1, 0);
                break;
            case '=':
            case ',': key_dots_ = 0; break;
            case '.':
                if (++key_dots_ >= kTomlMaxDepth) {
                    refuse(fmt::format("a dotted key of more than {} parts", kTomlMaxDepth));
                }
                break;
            default: break;
        }
        ++at_;
    }

    void skip_string(char quote) {
        const std::string three(3, quote);
        const bool multi_line = text_.substr(at_, 3) == three;
        const std::string_view end =
            multi_line ? std::string_view(three) : std::string_view(three).substr(0, 1);
        at_ += end.size();
        while (at_ < text_.size()) {
            if (text_.substr(at_, end.size()) == end) {
                at_ += end.size();
                return;
            }
            if (text_[at_] == '\n') {
                if (!multi_line) return;  // unterminated: the parser says so
                ++line_;
            }
            // A line break after the backslash is left for the next turn, which counts it.
            const bool escape = quote == '"' && text_[at_] == '\\' && at_ + 1 < text_.size() &&
                                text_[at_ + 1] != '\n';
            at_ += escape ? 2 : 1;
        }
    }

    std::string_view text_;
    const std::filesystem::path& file_;
    std::size_t at_ = 0;
    int line_ = 1;
    int depth_ = 0;
    int key_dots_ = 0;
};

std::string place(const toml::source_region& source, const std::filesystem::path& file) {
    if (source.path) return *source.path;              // a value of its own
    if (source.begin.line == 0) return file.string();  // made by the program, not parsed
    return fmt::format("{}:{}", file.string(), source.begin.line);
}

/// The parser's words, which quote the file's bytes: one line of plain text of bounded length.
std::string one_line(std::string_view text) {
    constexpr std::size_t kMaxBytes = 300;
    std::string line;
    bool cut = false;
    base::for_each_character(text, [&](std::string_view character, bool /*valid*/) {
        cut = cut || line.size() >= kMaxBytes;
        if (cut) return;
        line += character == "\n" ? " " : base::plain(character);
    });
    return cut ? line + "..." : line;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::filesystem::path& file) {
    Guard(text, file).check();
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}: not TOML: {}", place(error.source(), file),
                                     one_line(error.description())));
    }
}

toml::table parse_toml_value(const std::string& value, const std::string& where) {
    const std::string text = "value = " + value;
    Guard(text, where).check();
    try {
        toml::table table = toml::parse(text, where);
        if (table.size() == 1) return table;
    } catch (const toml::parse_error&) {
        // below
    }
    throw InputError(
        fmt::format("{}: {} is no value of TOML; write a number, true, false, \"text\" or [1, 2]",
                    where, base::printable(value)));
}

std::string read_toml_text(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) {
        throw InputError(fmt::format("{}: no such file", file.string()));
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw InputError(fmt::format("{}: not a file of text", file.string()));
    }
    std::ifstream stream(file, std::ios::binary);
    std::string text(kTomlMaxBytes + 1, '\0');
    stream.read(text.data(), std::streamsize(text.size()));
    if (!stream.is_open() || stream.bad()) {
        throw InputError(fmt::format("{}: cannot be read", file.string()));
    }
    text.resize(std::size_t(stream.gcount()));
    if (text.size() > kTomlMaxBytes) {
        throw InputError(fmt::format("{}: longer than {} bytes, the most that is read of TOML",
                                     file.string(), kTomlMaxBytes));
    }
    return text;
}

toml::table read_toml(const std::filesystem::path& file) {
    return parse_toml(read_toml_text(file), file);
}

std::string toml_place(const toml::node& node, const std::filesystem::path& file) {
    return place(node.source(), file);
}

std::string toml_place(const toml::key& key, const std::filesystem::path& file) {
    return place(key.source(), file);
}

}  // namespace lodbench::terrain
