// Looks for plugins and lists them, each opened in a child process of its own.

#include <fcntl.h>
#include <fmt/format.h>
#include <json/value.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <map>
#include <set>

#include "api/error.h"
#include "base/child_process.h"
#include "base/isolated.h"
#include "results/json.h"
#include "run/last_words.h"
#include "run/loader_log.h"
#include "run/locations.h"
#include "run/plugin_library.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

constexpr rlim_t kOutputLimit = 1 << 20;  // bytes of what a plugin prints while it is listed

Json::Value to_json(const ParamInfo& param) {
    Json::Value json;
    json["name"] = param.name;
    json["type"] = int(param.type);
    json["default"] = param.default_number;
    json["minimum"] = param.minimum;
    json["maximum"] = param.maximum;
    json["default_choice"] = param.default_choice;
    json["choices"] = results::array_of(param.choices);
    json["help"] = param.help;
    return json;
}

Json::Value to_json(const MethodInfo& method) {
    Json::Value json;
    json["id"] = method.id;
    json["title"] = method.title;
    json["citation"] = method.citation;
    json["version"] = method.version;
    json["capabilities"] = method.capabilities;
    json["gl_extensions"] = results::array_of(method.gl_extensions);
    json["params"] = Json::arrayValue;
    for (const ParamInfo& param : method.params) json["params"].append(to_json(param));
    json["quality_knob"] = method.quality_knob;
    json["claimed_bound"] = method.claimed_bound;
    json["compiled"] = method.compiled;
    return json;
}

ParamInfo read_param(const Json::Value& json, const std::string& where) {
    ParamInfo param;
    param.name = results::get_string(json, "name", where);
    param.type = ParamType(int(results::get_number(json, "type", where)));
    param.default_number = results::get_number(json, "default", where);
    param.minimum = results::get_number(json, "minimum", where);
    param.maximum = results::get_number(json, "maximum", where);
    param.default_choice = results::get_string(json, "default_choice", where);
    for (const Json::Value& choice : results::get_array(json, "choices", where)) {
        param.choices.push_back(choice.asString());
    }
    param.help = results::get_string(json, "help", where);
    return param;
}

MethodInfo read_method(const Json::Value& json, const std::string& where) {
    MethodInfo method;
    method.plugin = where;
    method.id = results::get_string(json, "id", where);
    method.title = results::get_string(json, "title", where);
    method.citation = results::get_string(json, "citation", where);
    method.version = results::get_string(json, "version", where);
    method.capabilities = std::uint32_t(results::get_number(json, "capabilities", where));
    for (const Json::Value& name : results::get_array(json, "gl_extensions", where)) {
        method.gl_extensions.push_back(name.asString());
    }
    for (const Json::Value& param : results::get_array(json, "params", where)) {
        method.params.push_back(read_param(param, where));
    }
    method.quality_knob = results::get_string(json, "quality_knob", where);
    method.claimed_bound = results::get_string(json, "claimed_bound", where);
    method.compiled = results::get_string(json, "compiled", where);
    return method;
}

/// In the child: opens the plugin and lists it.
std::string listing_of(const fs::path& plugin, int output) {
    // What a plugin prints belongs into no pipe that the user reads; and it may print without end.
    if (std::getenv("LODBENCH_LOADER_DEBUG") == nullptr) {
        dup2(output, STDOUT_FILENO);
        dup2(output, STDERR_FILENO);
    }
    // A constructor that calls exit() would run the exit handlers of libraries whose threads did
    // not come along into this fork: end before them.
    on_exit([](int status, void*) { _exit(status); }, nullptr);
    const rlimit limit{kOutputLimit, kOutputLimit};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    Json::Value methods = Json::arrayValue;
    for (const MethodInfo& method : PluginLibrary(plugin).methods()) {
        methods.append(to_json(method));
    }
    return results::to_text(methods);
}

/// Where the plugin stands among those that lodbench is built with; last for any other.
std::size_t rank_of(const fs::path& plugin) {
    constexpr std::string_view kOwn = LODBENCH_OWN_PLUGINS;  // ":full_grid:lindstrom:"
    return kOwn.find(':' + plugin.stem().string() + ':');
}

/// A plugin that holds an id, and what decides whether it is the one that is used.
struct Holder {
    PluginListing* listing;
    std::size_t folder;
    std::size_t rank = rank_of(listing->path);
    [[nodiscard]] bool goes_before(const Holder& other) const {
        return std::pair(folder, rank) < std::pair(other.folder, other.rank);
    }
};

/// `decided`: the first is used.
std::string words_of_conflict(const std::string& id, const Holder& first, const Holder& other,
                              bool decided) {
    const std::string held = fmt::format("method '{}' is held by two plugins: ", id);
    const std::string first_path = first.listing->path.string();
    const std::string other_path = other.listing->path.string();
    if (!decided) {
        return held + fmt::format(
                          "neither {} nor {} is used, for nothing tells which is meant; "
                          "remove one, or give its method another id",
                          first_path, other_path);
    }
    return held + fmt::format(
                      "{} is used, for {}; {} is not; remove one, or give its method "
                      "another id",
                      first_path,
                      first.folder < other.folder ? "its folder goes first"
                                                  : "lodbench was built with it first",
                      other_path);
}

void leave_out(PluginListing& listing, const std::string& id) {
    std::erase_if(listing.methods, [&](const MethodInfo& method) { return method.id == id; });
}

/// `folder_of` numbers the folder of each listing.
void settle_duplicates(std::vector<PluginListing>& listings,
                       const std::vector<std::size_t>& folder_of) {
    std::map<std::string, std::vector<Holder>> holders;
    for (std::size_t i = 0; i < listings.size(); ++i) {
        for (const MethodInfo& method : listings[i].methods) {
            holders[method.id].push_back({&listings[i], folder_of[i]});
        }
    }
    for (auto& [id, held] : holders) {
        if (held.size() < 2) continue;
        std::ranges::stable_sort(held, &Holder::goes_before);
        const bool decided = held[0].goes_before(held[1]);
        for (std::size_t i = 1; i < held.size(); ++i) {
            PluginListing& loser = *held[i].listing;
            loser.left_out.push_back(words_of_conflict(id, held[0], held[i], decided));
            loader_log("{}", loser.left_out.back());
            leave_out(loser, id);
        }
        if (!decided) leave_out(*held[0].listing, id);
    }
}

}  // namespace

std::vector<fs::path> plugin_folders(const std::vector<fs::path>& extra) {
    std::vector<fs::path> folders = extra;
    if (const char* variable = std::getenv("LODBENCH_PLUGIN_PATH")) {
        std::string_view rest = variable;
        while (!rest.empty()) {
            const std::size_t colon = std::min(rest.find(':'), rest.size());
            if (colon > 0) folders.emplace_back(rest.substr(0, colon));
            rest.remove_prefix(std::min(colon + 1, rest.size()));
        }
    }
    folders.push_back(default_plugin_folder());
    return folders;
}

PluginListing list_plugin(const fs::path& plugin, std::chrono::milliseconds time_limit) {
    PluginListing result;
    result.path = plugin;
    const auto refuse = [&](const std::string& why) {
        result.refusal = fmt::format("plugin {} cannot be used: {}", plugin.string(), why);
        loader_log("{}", result.refusal);
        return result;
    };
    const base::FileDescriptor output = base::memory_file("lodbench-output");
    const double seconds = double(time_limit.count()) / 1000;
    const base::Answer answer =
        base::run_isolated(seconds, [&] { return listing_of(plugin, output.number()); });
    const std::string printed = last_words(base::read_all(output));
    using base::Ending;
    switch (answer.ending) {
        case Ending::answered: break;
        case Ending::refused: result.refusal = answer.text; return result;
        case Ending::environment_error:
        case Ending::threw: return refuse(answer.text + printed);
        case Ending::died:
            return refuse(
                fmt::format("while it was loaded: {}{}; look at the constructors that run then",
                            answer.died_of, printed));
        case Ending::timed_out:
            return refuse(
                fmt::format("it did not load within {} s{}; a constructor that runs while it is "
                            "loaded does not end",
                            seconds, printed));
    }
    try {
        const Json::Value methods = results::parse_json(answer.text, plugin.string());
        for (const Json::Value& method : methods) {
            result.methods.push_back(read_method(method, plugin.string()));
        }
    } catch (const std::exception& error) {
        result.methods.clear();
        return refuse(fmt::format("its listing makes no sense: {}", error.what()));
    }
    return result;
}

std::vector<PluginListing> list_plugins(const std::vector<fs::path>& folders) {
    std::vector<PluginListing> listings;
    std::vector<std::size_t> folder_of;
    std::set<fs::path> seen;
    for (std::size_t number = 0; number < folders.size(); ++number) {
        const fs::path& folder = folders[number];
        loader_log("looking into {}", folder.string());
        std::error_code error;
        std::vector<fs::path> files;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            if (entry->path().extension() == ".so") files.push_back(entry->path());
        }
        if (error) {
            listings.push_back({folder,
                                {},
                                fmt::format("plugin folder {} cannot be read: {}; correct "
                                            "--plugin-dir or LODBENCH_PLUGIN_PATH",
                                            folder.string(), error.message())});
            folder_of.push_back(number);
            continue;
        }
        std::ranges::sort(files);
        for (const fs::path& file : files) {
            // The same file in two folders, or one folder named twice, is one plugin.
            std::error_code ignored;
            fs::path path = fs::canonical(file, ignored);
            if (path.empty()) path = fs::absolute(file);
            if (!seen.insert(path).second) continue;
            listings.push_back(list_plugin(path));
            folder_of.push_back(number);
        }
    }
    settle_duplicates(listings, folder_of);
    return listings;
}

const MethodInfo& find_method(const std::vector<PluginListing>& plugins, const std::string& id,
                              const std::string& where) {
    std::set<std::string> known;
    std::string refusals;
    for (const PluginListing& plugin : plugins) {
        for (const MethodInfo& method : plugin.methods) {
            if (method.id == id) return method;
            known.insert(method.id);
        }
        if (!plugin.refusal.empty()) refusals += "; " + plugin.refusal;
        for (const std::string& words : plugin.left_out) refusals += "; " + words;
    }
    throw InputError(fmt::format("{}: no method '{}' was found; known: {}{}", where, id,
                                 known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")),
                                 refusals));
}

}  // namespace lodbench::run
