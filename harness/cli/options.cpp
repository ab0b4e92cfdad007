#include "cli/options.h"

#include <fmt/format.h>
#include <json/writer.h>

#include <charconv>
#include <cmath>

#include "api/error.h"
#include "scenario/camera_string.h"

namespace lodbench::cli {

namespace {

Viewport parse_size(const std::string& text) {
    constexpr int kLargest = 16384;
    Viewport size;
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
        const auto height = std::from_chars(width.ptr + 1, end, size.height);
        if (height.ec == std::errc() && height.ptr == end && size.width >= 1 && size.height >= 1 &&
            size.width <= kLargest && size.height <= kLargest) {
            return size;
        }
    }
    throw InputError(
        fmt::format("--size {}: expected WIDTHxHEIGHT, each 1..{}, as 640x480", text, kLargest));
}

/// As TOML has it in an override.
std::string quoted(const std::string& text) {
    return Json::valueToQuotedString(text.c_str());
}

/// --camera and --flight: another flight in the place of the scenario's.
void add_other_flights(CLI::App& command, scenario::Overrides& overrides) {
    const auto fly = [&overrides](const std::string& flight, const std::string& where) {
        overrides.set("flight", flight, where);
        // Of the scenario's own flight.
        overrides.set("measure.shots", "[0]", where);
        overrides.set("measure.economy", "[]", where);
    };
    CLI::Option* const camera = command.add_option_function<std::string>(
        "--camera",
        [fly](const std::string& text) {
            static_cast<void>(scenario::parse_camera(text, "--camera"));
            fly(fmt::format("{{ kind = \"still\", camera = {} }}", quoted(text)), "--camera");
        },
        "stand there, in place of the flight: camera:X,Y,Z:HEADING,PITCH,ROLL:FOV:NEAR, as "
        "`lodbench view` copies it");
    command
        .add_option_function<std::string>(
            "--flight",
            [fly](const std::string& file) {
                const std::string path = std::filesystem::absolute(file).string();
                fly(fmt::format("{{ kind = \"recorded\", file = {} }}", quoted(path)),
                    "--flight " + file);
            },
            "fly a recorded path (CSV, as `lodbench view` records it) in place of the scenario's")
        ->type_name("FILE")
        ->excludes(camera);
}

}  // namespace

void add_plugin_dirs(CLI::App& command, std::vector<std::filesystem::path>& folders) {
    add_repeated(command, "--plugin-dir", folders,
                 "folder to search for plugins first: its methods are used before those of the "
                 "same id elsewhere");
}

void add_device(CLI::App& command, std::string& device) {
    command.add_option("--device", device,
                       "EGL device: number or part of its name, see `lodbench list --devices`");
}

void add_overrides(CLI::App& command, scenario::Overrides& overrides) {
    add_override<std::int64_t>(command, overrides, "--frames", "flight.frames",
                               "frames of the flight")
        ->check(CLI::Range(1, 1000000));
    command
        .add_option_function<std::string>(
            "--size",
            [&overrides](const std::string& text) {
                const Viewport size = parse_size(text);
                overrides.set("viewport.width", fmt::format("{}", size.width), "--size " + text);
                overrides.set("viewport.height", fmt::format("{}", size.height), "--size " + text);
            },
            "viewport in pixels, as 640x480")
        ->type_name("WIDTHxHEIGHT");
    add_other_flights(command, overrides);
    command
        .add_option_function<std::vector<std::string>>(
            "--override",
            [&overrides](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    const std::size_t equals = text.find('=');
                    if (equals == 0 || equals == text.npos) {
                        throw InputError(fmt::format(
                            "--override {}: expected KEY=VALUE, as measure.every=4", text));
                    }
                    overrides.set(text.substr(0, equals), text.substr(equals + 1),
                                  "--override " + text);
                }
            },
            "KEY=VALUE, in place of the scenario's: measure.every=4 (again for more)")
        ->allow_extra_args(false)
        ->type_name("TEXT");
}

CLI::Validator finite_and_positive(const std::string& what) {
    return {[what](std::string& text) {
                double value = 0;
                const char* end = text.data() + text.size();
                const auto read = std::from_chars(text.data(), end, value);
                const bool good =
                    read.ec == std::errc() && read.ptr == end && std::isfinite(value) && value > 0;
                return good ? std::string()
                            : fmt::format("{} is {}: expected a finite number above 0", what, text);
            },
            "POSITIVE"};
}

void add_time_limit(CLI::App& command, std::optional<double>& seconds, const std::string& help) {
    command.add_option("--time-limit", seconds, "limit " + help)
        ->check(finite_and_positive("the limit"));
}

CLI::Option* add_seed(CLI::App& command, std::uint64_t& seed, const std::string& help) {
    // CLI11 would wrap a negative number round.
    return command
        .add_option_function<std::string>(
            "--seed",
            [&seed](const std::string& text) {
                const char* end = text.data() + text.size();
                const auto read = std::from_chars(text.data(), end, seed);
                if (read.ec != std::errc() || read.ptr != end) {
                    throw InputError(fmt::format(
                        "--seed {}: expected a whole number from 0 to 18446744073709551615", text));
                }
            },
            help)
        ->type_name("UINT");
}

void expect_results_folder(const std::filesystem::path& path, const char* or_else) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return;
    throw InputError(fmt::format(
        "{}: there is no such folder; name a results folder, as `lodbench run --out DIR` writes "
        "it{}",
        path.string(), or_else));
}

std::vector<run::PluginListing> find_plugins(
    const std::vector<std::filesystem::path>& plugin_dirs) {
    return run::list_plugins(run::plugin_folders(plugin_dirs));
}

}  // namespace lodbench::cli
