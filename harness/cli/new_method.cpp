// lodbench new-method NAME: a copy of the template with everything named NAME, ready to build and
// fly.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/error.h"
#include "base/console.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "run/locations.h"

namespace lodbench::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLongestName = 64;
constexpr std::array kTemplateFiles = {"CMakeLists.txt", "README.md", "template_method.cpp",
                                       "template_method.vert"};

/// The three spellings of one name.
struct MethodName {
    std::string id;          ///< "my-method"
    std::string snake_case;  ///< "my_method": files, target, folder
    std::string class_name;  ///< "MyMethod"
};

bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}

bool is_valid(const std::string& id) {
    return !id.empty() && id.size() <= kLongestName && is_lower(id.front()) &&
           std::all_of(id.begin(), id.end(),
                       [](char c) { return is_lower(c) || (c >= '0' && c <= '9') || c == '-'; });
}

MethodName parse_name(const std::string& id) {
    if (!is_valid(id)) {
        throw InputError(
            fmt::format("new-method '{}': a name is a lower-case letter, then up to {} of a-z, "
                        "0-9 and '-'; for example 'my-method'",
                        id, kLongestName - 1));
    }
    MethodName name{id, id, ""};
    std::replace(name.snake_case.begin(), name.snake_case.end(), '-', '_');
    bool word_begins = true;
    for (const char c : id) {
        if (c != '-') name.class_name += word_begins && is_lower(c) ? char(c - 'a' + 'A') : c;
        word_begins = c == '-';
    }
    // CMake's own target names, and the folders of methods/ that are no plugin.
    constexpr std::array kReserved = {"common", "template", "template-method",
                                      "all",    "clean",    "install",
                                      "test",   "help",     "lodbench"};
    if (std::find(kReserved.begin(), kReserved.end(), id) != kReserved.end()) {
        throw InputError(fmt::format(
            "new-method '{}': the name is taken by lodbench or CMake; choose another", id));
    }
    return name;
}

/// Of two plugins with one id one is not used: better told now than when the second is built.
void refuse_id_in_use(const std::string& id) {
    for (const run::PluginListing& plugin : find_plugins({})) {
        for (const run::MethodInfo& method : plugin.methods) {
            if (method.id != id) continue;
            throw InputError(
                fmt::format("new-method '{}': {} holds a method of that id; choose another", id,
                            plugin.path.string()));
        }
    }
}

fs::path template_folder() {
    // Beside the scenarios, in a source tree as in an installed prefix.
    const fs::path parent = run::scenario_folder().parent_path();
    const std::array places = {parent / "methods" / "template", parent / "template"};
    for (const fs::path& place : places) {
        if (fs::exists(place / "template_method.cpp")) return place;
    }
    throw EnvironmentError(
        fmt::format("the template of methods is neither in {} nor in {}; install lodbench whole",
                    places[0].string(), places[1].string()));
}

std::string rename_all(std::string text, const MethodName& name) {
    const std::array<std::pair<std::string, std::string>, 5> renames = {
        {{"template_method", name.snake_case},
         {"TemplateMethod", name.class_name},
         {"\"template\"", '"' + name.id + '"'},
         {"lodbench::kExample", "0"},
         {"# template\n", "# " + name.id + '\n'}}};
    for (const auto& [from, to] : renames) {
        for (std::size_t at = text.find(from); at != std::string::npos;
             at = text.find(from, at + to.size())) {
            text.replace(at, from.size(), to);
        }
    }
    return text;
}

/// Copies into a fresh folder beside `folder` and moves that into place: whole or not at all.
void copy_template(const fs::path& folder, const MethodName& name) {
    const fs::path source = template_folder();
    std::error_code error;
    if (fs::exists(fs::symlink_status(folder, error))) {
        throw InputError(
            fmt::format("{} exists already and is left as it is; choose another name or --dir",
                        folder.string()));
    }
    const fs::path unfinished = folder.string() + ".unfinished";
    fs::create_directories(folder.parent_path(), error);
    if (!fs::create_directory(unfinished, error)) {
        throw EnvironmentError(fmt::format("cannot create {}: {}", unfinished.string(),
                                           error ? error.message() : "it exists; remove it"));
    }
    try {
        for (const char* file : kTemplateFiles) {
            base::write_whole(unfinished / rename_all(file, name),
                              rename_all(base::read_text(source / file), name));
        }
        fs::rename(unfinished, folder, error);
        if (error) {
            throw EnvironmentError(
                fmt::format("cannot create {}: {}", folder.string(), error.message()));
        }
    } catch (...) {
        fs::remove_all(unfinished, error);
        throw;
    }
}

void add_to_tree(const fs::path& list, const MethodName& name) {
    std::string text = base::read_text(list);
    if (!text.empty() && text.back() != '\n') text += '\n';
    text += fmt::format("add_subdirectory({})\n", name.snake_case);
    base::write_whole(list, text);
}

/// For a shell: as it is where nothing in it is special, else in single quotes.
std::string quoted(const fs::path& path) {
    const std::string text = path.string();
    const auto plain = [](char c) {
        return is_lower(c) || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::strchr("/._-+,:=@%", c) != nullptr;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

void print_steps(const fs::path& folder, const std::vector<std::string>& steps) {
    base::print("{} is a method that flies. Next:\n", folder.string());
    for (const std::string& step : steps) base::print("  {}\n", step);
}

/// Where this program is installed, or the folder that it was built in.
fs::path prefix_of_this() {
    return run::executable_path().parent_path().parent_path();
}

bool is_build_tree(const fs::path& folder) {
    return fs::exists(folder / "CMakeCache.txt");
}

/// With this program's own build where that lies in this checkout, else with the preset's.
std::vector<std::string> steps_in_tree(const std::string& id, const MethodName& name) {
    fs::path build = fs::proximate(prefix_of_this());
    std::vector<std::string> steps;
    if (*build.begin() == ".." || !is_build_tree(build)) {
        build = "build/release";
        steps.emplace_back("cmake --preset release");
    }
    const std::string program = quoted(build / "bin" / "lodbench");
    steps.push_back(
        fmt::format("cmake --build {} --target lodbench {}", quoted(build), name.snake_case));
    steps.push_back(fmt::format("{} run --method {} --frames 30", program, id));
    steps.push_back(fmt::format("{} validate {}", program,
                                quoted(build / "plugins" / (name.snake_case + ".so"))));
    return steps;
}

void new_method(const std::string& id, const std::string& directory) {
    const MethodName name = parse_name(id);
    refuse_id_in_use(id);
    const fs::path list = fs::path("methods") / "CMakeLists.txt";
    if (directory.empty() && fs::exists(list)) {
        const fs::path folder = fs::path("methods") / name.snake_case;
        copy_template(folder, name);
        add_to_tree(list, name);
        print_steps(folder, steps_in_tree(id, name));
        return;
    }
    const fs::path folder = fs::path(directory) / id;
    copy_template(folder, name);
    const fs::path program = run::executable_path();
    fs::path prefix = prefix_of_this();
    std::vector<std::string> steps;
    if (is_build_tree(prefix)) {
        // Not an installed lodbench but the one in its build tree: find_package needs an installed
        // one.
        const fs::path build = prefix;
        prefix = build / "installed";
        steps.push_back(
            fmt::format("cmake --install {} --prefix {}", quoted(build), quoted(prefix)));
    }
    const fs::path build = folder / "build";
    steps.push_back(fmt::format("cmake -S {} -B {} -DCMAKE_PREFIX_PATH={}", quoted(folder),
                                quoted(build), quoted(prefix)));
    steps.push_back(fmt::format("cmake --build {}", quoted(build)));
    steps.push_back(
        fmt::format("{} run --plugin-dir {} --method {}", quoted(program), quoted(build), id));
    print_steps(folder, steps);
}

}  // namespace

void add_new_method(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand(
        "new-method",
        "Write a new method, ready to build and fly: methods/NAME in a checkout of lodbench "
        "(and its line in methods/CMakeLists.txt), elsewhere a project of its own");
    const auto name = std::make_shared<std::string>();
    const auto directory = std::make_shared<std::string>();
    command->add_option("NAME", *name, "lower-case letter, then a-z, 0-9 and '-'")->required();
    command->add_option("--dir", *directory, "write a project of its own into this folder");
    command->callback([name, directory] { new_method(*name, *directory); });
}

}  // namespace lodbench::cli
