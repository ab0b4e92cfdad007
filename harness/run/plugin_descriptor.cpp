#include "run/plugin_descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

namespace lodbench::run {

namespace {

// Far more than any plugin holds: a count beyond it is a corrupted descriptor.
constexpr std::size_t kMaxMethods = 256;
constexpr std::size_t kMaxParams = 256;
constexpr std::size_t kMaxExtensions = 64;
constexpr double kMaxExactInteger = 9007199254740992.0;  // 2^53

constexpr const char* kRebuild = "build it again with this lodbench's headers";

[[noreturn]] void refuse(const std::string& what) {
    throw DescriptorError(what);
}

void check_header(const PluginDescriptor& descriptor) {
    if (descriptor.abi != kAbi) {
        refuse(fmt::format("its interface number is {}, expected {}; {}", descriptor.abi, kAbi,
                           kRebuild));
    }
    if (descriptor.struct_size != sizeof(PluginDescriptor)) {
        refuse(fmt::format("its descriptor has {} bytes, expected {}; {}", descriptor.struct_size,
                           sizeof(PluginDescriptor), kRebuild));
    }
    if (descriptor.abi_tag == nullptr) {
        refuse(fmt::format("its ABI tag is missing, expected '{}'; {}", kAbiTag, kRebuild));
    }
    if (std::string_view(descriptor.abi_tag) != kAbiTag) {
        refuse(fmt::format("its ABI tag is '{}', expected '{}'; {}", descriptor.abi_tag, kAbiTag,
                           kRebuild));
    }
    if (descriptor.method_stride != sizeof(MethodDescriptor)) {
        refuse(fmt::format("its method entries are {} bytes apart, expected {}; {}",
                           descriptor.method_stride, sizeof(MethodDescriptor), kRebuild));
    }
    if (descriptor.methods == nullptr || descriptor.method_count == 0 ||
        descriptor.method_count > kMaxMethods) {
        refuse(fmt::format("it lists {} methods{}, expected 1 to {}; use LODBENCH_PLUGIN",
                           descriptor.method_count,
                           descriptor.methods == nullptr ? " at a null pointer" : "", kMaxMethods));
    }
}

std::string line_of_text(const char* text, const std::string& what) {
    if (text == nullptr) refuse(fmt::format("{} is a null pointer, expected a text", what));
    const std::string_view view(text);
    if (view.find_first_of("\n\r") != std::string_view::npos) {
        refuse(fmt::format("{} has more than one line", what));
    }
    return std::string(view);
}

bool is_identifier(std::string_view text, std::string_view more) {
    return !text.empty() && std::ranges::all_of(text, [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || more.find(c) != more.npos;
    });
}

std::vector<std::string> split_choices(const char* choices) {
    std::vector<std::string> result(1);
    for (const char* c = choices; *c != '\0'; ++c) {
        if (*c == '|') {
            result.emplace_back();
        } else {
            result.back() += *c;
        }
    }
    return result;
}

void check_number(const ParamInfo& param, const std::string& what) {
    if (!std::isfinite(param.minimum) || !std::isfinite(param.maximum) ||
        !std::isfinite(param.default_number) || param.minimum > param.maximum) {
        refuse(fmt::format("{} has default {} and range {}..{}, expected finite numbers in order",
                           what, param.default_number, param.minimum, param.maximum));
    }
    if (param.default_number < param.minimum || param.default_number > param.maximum) {
        refuse(fmt::format("{} has default {}, outside its range {}..{}", what,
                           param.default_number, param.minimum, param.maximum));
    }
    if (param.type != ParamType::integer) return;
    for (const double value : {param.default_number, param.minimum, param.maximum}) {
        if (value != std::floor(value) || std::abs(value) > kMaxExactInteger) {
            refuse(fmt::format("{} is an integer but has {} as default or limit", what, value));
        }
    }
}

ParamInfo read_param(const ParamSpec& spec, const std::string& method) {
    ParamInfo info;
    info.name = line_of_text(spec.name, fmt::format("a parameter name of method '{}'", method));
    const std::string what = fmt::format("parameter '{}' of method '{}'", info.name, method);
    if (!is_identifier(info.name, "_-")) refuse(what + " must be named with [a-z0-9_-]+");
    info.help = line_of_text(spec.help, "the help of " + what);
    info.type = spec.type;
    info.default_number = spec.default_number;
    info.minimum = spec.minimum;
    info.maximum = spec.maximum;
    switch (spec.type) {
        case ParamType::boolean:
            if (spec.default_number != 0 && spec.default_number != 1) {
                refuse(fmt::format("{} is a boolean with default {}, expected 0 or 1", what,
                                   spec.default_number));
            }
            break;
        case ParamType::integer:
        case ParamType::real: check_number(info, what); break;
        case ParamType::choice: {
            info.default_choice = line_of_text(spec.default_choice, "the default of " + what);
            info.choices =
                split_choices(line_of_text(spec.choices, "the choices of " + what).c_str());
            if (std::ranges::find(info.choices, "") != info.choices.end()) {
                refuse(fmt::format("{} has an empty choice in '{}'", what, spec.choices));
            }
            if (std::ranges::find(info.choices, info.default_choice) == info.choices.end()) {
                refuse(fmt::format("{} has default '{}', which is none of its choices '{}'", what,
                                   info.default_choice, spec.choices));
            }
            break;
        }
        default: refuse(fmt::format("{} has type {}, expected 0 to 3", what, int(spec.type)));
    }
    return info;
}

/// "" for a null pointer, else the name of a declared parameter.
std::string declared_name(const char* name, const MethodInfo& info, const char* role) {
    if (name == nullptr) return {};
    for (const ParamInfo& param : info.params) {
        if (param.name != name) continue;
        if (param.type == ParamType::integer || param.type == ParamType::real) return name;
        refuse(fmt::format("the {} '{}' of method '{}' is not a number", role, name, info.id));
    }
    refuse(
        fmt::format("the {} '{}' of method '{}' is not among its parameters", role, name, info.id));
}

MethodInfo read_method(const MethodDescriptor& method, std::size_t index) {
    MethodInfo info;
    info.id = line_of_text(method.id, fmt::format("the id of method {}", index));
    if (!is_identifier(info.id, "-")) {
        refuse(fmt::format("the id of method {} is '{}', expected [a-z0-9-]+", index, info.id));
    }
    const std::string of = fmt::format(" of method '{}'", info.id);
    info.title = line_of_text(method.title, "the title" + of);
    info.citation = line_of_text(method.citation, "the citation" + of);
    info.version = line_of_text(method.version, "the version" + of);
    info.capabilities = method.capabilities;
    if (method.gl_extensions != nullptr) {
        for (std::size_t i = 0; method.gl_extensions[i] != nullptr; ++i) {
            if (i == kMaxExtensions)
                refuse("the list of GL extensions" + of + " has no null at its end");
            info.gl_extensions.push_back(
                line_of_text(method.gl_extensions[i], "a GL extension" + of));
        }
    }
    if (method.param_count > kMaxParams || (method.param_count > 0 && method.params == nullptr)) {
        refuse(fmt::format("method '{}' declares {} parameters{}, expected 0 to {}", info.id,
                           method.param_count, method.params == nullptr ? " at a null pointer" : "",
                           kMaxParams));
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < method.param_count; ++i) {
        info.params.push_back(read_param(method.params[i], info.id));
        if (!names.insert(info.params.back().name).second) {
            refuse(fmt::format("method '{}' declares parameter '{}' twice", info.id,
                               info.params.back().name));
        }
    }
    info.quality_knob = declared_name(method.quality_knob, info, "quality knob");
    info.claimed_bound = declared_name(method.claimed_bound, info, "claimed bound");
    if (method.create == nullptr || method.destroy == nullptr) {
        refuse(fmt::format("method '{}' has no {}; use create_method and destroy_method", info.id,
                           method.create == nullptr ? "create" : "destroy"));
    }
    return info;
}

}  // namespace

std::vector<MethodInfo> read_descriptor(const PluginDescriptor& descriptor,
                                        const std::filesystem::path& plugin) {
    check_header(descriptor);
    std::vector<MethodInfo> methods;
    std::set<std::string> ids;
    for (std::size_t i = 0; i < descriptor.method_count; ++i) {
        methods.push_back(read_method(descriptor.methods[i], i));
        methods.back().plugin = plugin;
        methods.back().compiled = line_of_text(descriptor.compiled, "how it was compiled");
        if (!ids.insert(methods.back().id).second) {
            refuse(fmt::format("it holds two methods with the id '{}'; give each its own",
                               methods.back().id));
        }
    }
    return methods;
}

}  // namespace lodbench::run
