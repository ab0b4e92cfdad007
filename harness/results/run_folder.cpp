#include "results/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <set>
#include <thread>
#include <utility>

#include "api/error.h"
#include "base/files.h"
#include "base/printable.h"
#include "results/folder.h"
#include "results/json.h"

namespace lodbench::results {

namespace fs = std::filesystem;

namespace {

// A killed run's child is killed with it, but dies a moment later.
constexpr int kLockAttempts = 50;
constexpr auto kLockPause = std::chrono::milliseconds(100);

constexpr const char* kLock = ".lock";
constexpr const char* kViews = "views";
constexpr std::array kParts = {"scenarios", "frames", "flights", "logs", "shots", kViews};
/// What the commands that fly write beside the subfolders.
constexpr std::array kDocuments = {"run.json", "match.json", "summary.md",
                                   "trade.md", "match.md",   "economy.md"};

fs::file_type type_of(const fs::path& path) {
    std::error_code ignored;
    return fs::symlink_status(path, ignored).type();
}

bool is_temporary_of(const std::string& file, const std::string& name) {
    return file.starts_with("." + name + ".") && file.ends_with(".tmp");
}

/// NAME.* or NAME__*, or the temporary file of one.
bool bears_name(std::string_view file, const std::string& name) {
    if (file.starts_with('.') && file.ends_with(".tmp")) file.remove_prefix(1);
    if (!file.starts_with(name)) return false;
    file.remove_prefix(name.size());
    return file.starts_with('.') || file.starts_with("__");
}

/// What a run that was killed before its first document stood may leave.
bool is_beginning(const fs::path& file) {
    const std::string name = file.filename().string();
    return type_of(file) == fs::file_type::regular &&
           (name == kLock || is_temporary_of(name, "run.json") ||
            is_temporary_of(name, "match.json"));
}

}  // namespace

void refuse_foreign_folder(const fs::path& path) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(
            fmt::format("{}: {}; name a new or an empty folder with --out", path.string(), why));
    };
    switch (type_of(path)) {
        case fs::file_type::not_found: return;
        case fs::file_type::directory: break;
        case fs::file_type::symlink:
            refuse("this is a symbolic link, and results are not written through one");
            break;
        default: refuse("this is not a folder");
    }
    for (const char* document : {"run.json", "match.json"}) {
        const fs::file_type type = type_of(path / document);
        if (type == fs::file_type::regular) return;
        if (type != fs::file_type::not_found) {
            refuse(fmt::format("its {} is no plain file, but a link, pipe, folder or device",
                               document));
        }
    }
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error)) {
        if (is_beginning(entry->path())) continue;
        refuse(fmt::format("this folder holds what lodbench did not make ({})",
                           base::printable(entry->path().filename().string())));
    }
    if (error) refuse(fmt::format("this folder cannot be read ({})", error.message()));
}

bool holds_a_run(const fs::path& folder) {
    return type_of(folder / "run.json") == fs::file_type::regular;
}

RunFolder::RunFolder(fs::path path) : path_(std::move(path)) {
    refuse_foreign_folder(path_);
    for (fs::path folder = path_; type_of(folder) == fs::file_type::not_found;
         folder = folder.parent_path()) {
        made_.insert(made_.begin(), folder);
    }
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) {
        throw EnvironmentError(
            fmt::format("cannot make the folder {}: {}; choose another with --out", path_.string(),
                        error.message()));
    }
    lock();
    refuse_foreign_folder(path_);  // another run may have begun here in between
}

void RunFolder::lock() {
    const fs::path file = path_ / kLock;
    lock_ = base::FileDescriptor(
        open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644));
    if (!lock_ || type_of(file) != fs::file_type::regular) {
        throw EnvironmentError(fmt::format("cannot write {}: {}; choose another folder with --out",
                                           file.string(),
                                           lock_ ? "not a regular file" : std::strerror(errno)));
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

void RunFolder::make_parts() {
    for (const char* part : kParts) {
        const fs::path folder = path_ / part;
        std::error_code error;
        if (fs::create_directory(folder, error)) {
            made_.push_back(folder);
        } else if (error) {
            throw EnvironmentError(
                fmt::format("cannot make the folder {}: {}; choose another with --out",
                            folder.string(), error.message()));
        }
        if (type_of(folder) == fs::file_type::directory) continue;
        throw InputError(fmt::format(
            "{}: this is not a folder, and results are not written through a link; restore the "
            "folder, or begin anew with another --out",
            folder.string()));
    }
}

std::vector<fs::path> RunFolder::own_files(bool temporary_only) const {
    std::vector<fs::path> files;
    const auto collect = [&](const fs::path& folder, const auto& is_own) {
        std::error_code ignored;
        if (type_of(folder) != fs::file_type::directory) return;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
            const std::string name = entry.path().filename().string();
            const bool temporary = name.starts_with('.') && name.ends_with(".tmp");
            if (type_of(entry.path()) == fs::file_type::regular && (temporary || !temporary_only) &&
                is_own(name)) {
                files.push_back(entry.path());
            }
        }
    };
    collect(path_, [](const std::string& name) {
        return std::ranges::any_of(kDocuments, [&](const char* document) {
            return name == document || is_temporary_of(name, document);
        });
    });
    for (const char* part : kParts) {
        collect(path_ / part, [this](const std::string& file) {
            return std::ranges::any_of(
                names_, [&](const std::string& name) { return bears_name(file, name); });
        });
    }
    return files;
}

fs::path RunFolder::views() const {
    return path_ / kViews;
}

void RunFolder::drop_views() {
    std::error_code ignored;
    for (const fs::path& file : own_files(false)) {
        if (file.parent_path() == views()) fs::remove(file, ignored);
    }
    fs::remove(views(), ignored);  // fails, as it should, where something else lies in it
}

void RunFolder::discard() {
    std::error_code ignored;
    for (const fs::path& file : own_files(false)) fs::remove(file, ignored);
    fs::remove(path_ / kLock, ignored);
    // Fails, as it should, where something else lies in one.
    for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) {
        fs::remove(*folder, ignored);
    }
}

std::vector<CellRecord> RunFolder::repair() {
    const fs::path file = path_ / "cells.jsonl";
    std::vector<CellRecord> cells;
    std::set<std::string> ids;
    for (const std::string& line : base::read_lines(file, true)) {
        const std::string where = fmt::format("{}:{}", file.string(), cells.size() + 1);
        CellRecord cell = read_cell(parse_sealed(line, where), where);
        if (!ids.insert(cell.cell).second) {
            throw InputError(fmt::format("{}: cell '{}' is there twice; remove one of its lines",
                                         where, cell.cell));
        }
        if (!cell.frames_checksum.empty()) {
            const fs::path frames = path_ / "frames" / (cell.cell + ".csv");
            expect_frames(cell, base::read_text(frames), frames.string());
        }
        cells.push_back(std::move(cell));
    }
    for (const fs::path& leftover : own_files(true)) fs::remove(leftover);
    return cells;
}

void RunFolder::add_cell(const CellRecord& cell, const std::string& csv) {
    const fs::path frames = path_ / "frames" / (cell.cell + ".csv");
    base::write_whole(frames, csv);
    try {
        base::append_line(path_ / "cells.jsonl", seal(to_json(cell)));
    } catch (...) {
        std::error_code ignored;
        fs::remove(frames, ignored);
        throw;
    }
}

}  // namespace lodbench::results
