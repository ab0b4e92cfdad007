#include "run/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "api/error.h"
#include "report/json.h"
#include "report/results.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

// A killed run's child is killed with it, but dies a moment later.
constexpr int kLockAttempts = 50;
constexpr auto kLockPause = std::chrono::milliseconds(100);

void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}; choose another with --out", path.string(),
                        error.message()));
    }
}

}  // namespace

RunFolder::RunFolder(fs::path path) : path_(std::move(path)) {
    for (const char* part : {"", "scenarios", "frames", "logs", "shots"}) make_folder(path_ / part);
    const fs::path file = path_ / ".lock";
    lock_ = base::FileDescriptor(open(file.c_str(), O_RDWR | O_CREAT, 0644));
    if (!lock_) {
        throw EnvironmentError(fmt::format("cannot write {}: {}; choose another folder with --out",
                                           file.string(), std::strerror(errno)));
    }
    for (int attempt = 0; flock(lock_.number(), LOCK_EX | LOCK_NB) != 0; ++attempt) {
        if (errno != EWOULDBLOCK && errno != EINTR) {
            throw EnvironmentError(
                fmt::format("cannot lock {}: {}", file.string(), std::strerror(errno)));
        }
        if (attempt == kLockAttempts) {
            throw InputError(
                fmt::format("{}: another run is writing into this folder; wait for it or choose "
                            "another with --out",
                            path_.string()));
        }
        std::this_thread::sleep_for(kLockPause);
    }
}

bool RunFolder::holds_a_run() const {
    return fs::exists(path_ / "run.json") || fs::exists(path_ / "cells.jsonl");
}

void RunFolder::discard() {
    std::error_code ignored;
    for (const char* part :
         {"scenarios", "frames", "flights", "logs", "shots", "run.json", ".lock"}) {
        fs::remove_all(path_ / part, ignored);
    }
    fs::remove(path_, ignored);  // fails, as it should, where something else lies in it
}

std::vector<Json::Value> RunFolder::repair() {
    const fs::path file = path_ / "cells.jsonl";
    std::vector<Json::Value> cells;
    std::set<std::string> ids;
    for (const std::string& line : report::read_lines(file, true)) {
        const std::string where = fmt::format("{}:{}", file.string(), cells.size() + 1);
        Json::Value cell = report::parse_json(line, where);
        const std::string id = report::get_string(cell, "cell", where);
        if (!ids.insert(id).second) {
            throw InputError(
                fmt::format("{}: cell '{}' is there twice; remove one of its lines", where, id));
        }
        cells.push_back(std::move(cell));
    }
    std::vector<fs::path> leftovers;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path_)) {
        const fs::path& path = entry.path();
        const bool temporary =
            path.extension() == ".tmp" && path.filename().string().starts_with(".");
        const bool orphan =
            path.parent_path() == path_ / "frames" && !ids.contains(path.stem().string());
        if (entry.is_regular_file() && (temporary || orphan)) leftovers.push_back(path);
    }
    for (const fs::path& path : leftovers) fs::remove(path);
    return cells;
}

void RunFolder::add_cell(const std::string& id, const Json::Value& record, const std::string& csv) {
    const fs::path frames = path_ / "frames" / (id + ".csv");
    report::write_whole(frames, csv);
    try {
        report::append_line(path_ / "cells.jsonl", report::to_text(record));
    } catch (...) {
        std::error_code ignored;
        fs::remove(frames, ignored);
        throw;
    }
}

}  // namespace lodbench::run
