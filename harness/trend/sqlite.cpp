#include "trend/sqlite.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "api/error.h"
#include "base/files.h"

namespace lodbench::trend {

namespace fs = std::filesystem;

namespace {

/// Adding a run takes milliseconds: who waits longer waits for a process that hangs.
constexpr int kBusyMs = 60'000;

void expect_plain_file(const fs::path& path, Connection::Mode mode) {
    std::error_code ignored;
    const fs::file_type type = fs::status(path, ignored).type();
    if (type == fs::file_type::not_found) {
        if (mode == Connection::Mode::add) return;
        throw InputError(fmt::format(
            "{0}: there is no such database; `lodbench trend add RUN --db {0}` makes it",
            path.string()));
    }
    if (type == fs::file_type::regular || type == fs::file_type::none) return;
    throw InputError(
        fmt::format("{}: this is no file (but a folder, pipe or device); name the "
                    "history's file with --db",
                    path.string()));
}

std::string no_database(const fs::path& path, const char* why) {
    return fmt::format("{}: this is no database of `lodbench trend` ({}); name another with --db",
                       path.string(), why);
}

/// The system's error behind SQLite's last one; 0 where there is none.
int system_error_of(sqlite3* handle) {
    if (const int error = sqlite3_system_errno(handle); error != 0) return error;
    int error = 0;  // of a commit that failed only the file knows
    sqlite3_file_control(handle, "main", SQLITE_FCNTL_LAST_ERRNO, &error);
    return error;
}

bool is_full(int code, int system_error) {
    return (code & 0xFF) == SQLITE_FULL ||
           ((code & 0xFF) == SQLITE_IOERR &&
            (system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG));
}

}  // namespace

Connection::Connection(fs::path path, Mode mode) : path_(std::move(path)) {
    sqlite3* handle = nullptr;
    int code = SQLITE_OK;
    if (mode == Mode::memory) {
        code = sqlite3_open_v2(":memory:", &handle,
                               SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_MEMORY,
                               nullptr);
    } else {
        expect_plain_file(path_, mode);
        // Who reads may have to undo what a killed adder left, and so opens for writing as well; a
        // file that is write-protected is opened for reading by SQLite itself. An absolute path is
        // none of SQLite's special names.
        const int flags = SQLITE_OPEN_READWRITE | (mode == Mode::add ? SQLITE_OPEN_CREATE : 0);
        code = sqlite3_open_v2(fs::absolute(path_).c_str(), &handle, flags, nullptr);
    }
    handle_.reset(handle);
    if (handle == nullptr) throw EnvironmentError("SQLite has no memory for a database");
    if (code != SQLITE_OK) fail(code);
    configure();
}

void Connection::configure() const {
    sqlite3_extended_result_codes(handle(), 1);
    sqlite3_busy_timeout(handle(), kBusyMs);
    const auto set = [&](int option, int value) {
        sqlite3_db_config(handle(), option, value, nullptr);
    };
    set(SQLITE_DBCONFIG_DEFENSIVE, 1);
    set(SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0);
    set(SQLITE_DBCONFIG_ENABLE_TRIGGER, 0);
    set(SQLITE_DBCONFIG_ENABLE_VIEW, 0);
    sqlite3_limit(handle(), SQLITE_LIMIT_LENGTH, 16 << 20);  // bytes of a text
    sqlite3_limit(handle(), SQLITE_LIMIT_ATTACHED, 0);
    // A file may be cut short while it is read, which would end the process were it mapped.
    for (const char* sql :
         {"PRAGMA mmap_size = 0", "PRAGMA cell_size_check = ON", "PRAGMA synchronous = FULL"}) {
        Statement statement(*this, sql);
        while (statement.step()) {
        }
    }
}

void Connection::run(const char* sql) const {
    Statement(*this, sql).finish();
}

void Connection::damaged(std::string_view what) const {
    throw InputError(
        fmt::format("{}: the database is damaged: {}; restore a copy of it, or make "
                    "it anew with `lodbench trend add` from the results folders",
                    path_.string(), what));
}

void Connection::fail(int code) const {
    const std::string words = sqlite3_errmsg(handle());
    const int system_error = system_error_of(handle());
    if (is_full(code, system_error)) {
        throw base::DiskFullError(fmt::format(
            "cannot write {}: {}; the history is as it was: make room there, or choose another "
            "place with --db",
            path_.string(), system_error != 0 ? std::strerror(system_error) : words));
    }
    switch (code & 0xFF) {
        case SQLITE_NOTADB: throw InputError(no_database(path_, words.c_str()));
        case SQLITE_CORRUPT: damaged(words);
        case SQLITE_ERROR: damaged(words);  // a table or column is not there
        case SQLITE_TOOBIG: damaged(words);
        case SQLITE_BUSY:
            throw EnvironmentError(fmt::format(
                "{}: another process has held the database for {} s; end it, and try again",
                path_.string(), kBusyMs / 1000));
        case SQLITE_READONLY:
        case SQLITE_CANTOPEN:
        case SQLITE_PERM:
            throw EnvironmentError(fmt::format(
                "cannot write {}: {}; make the file and its folder, where the journal stands, "
                "writable, or choose another place with --db",
                path_.string(), words));
        default:
            throw EnvironmentError(
                fmt::format("cannot use {}: {}{}{}; is it the right place?", path_.string(), words,
                            system_error != 0 ? ": " : "",
                            system_error != 0 ? std::strerror(system_error) : ""));
    }
}

Statement::Statement(const Connection& connection, const char* sql) : connection_(connection) {
    sqlite3_stmt* statement = nullptr;
    expect(sqlite3_prepare_v2(connection.handle(), sql, -1, &statement, nullptr));
    statement_.reset(statement);
}

void Statement::expect(int code) const {
    if (code != SQLITE_OK) connection_.fail(code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
    expect(sqlite3_bind_int64(statement_.get(), parameter, value));
    return *this;
}

Statement& Statement::bind(int parameter, double value) {
    expect(sqlite3_bind_double(statement_.get(), parameter, value));
    return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
    expect(sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(),
                               SQLITE_TRANSIENT, SQLITE_UTF8));
    return *this;
}

Statement& Statement::bind_null(int parameter) {
    expect(sqlite3_bind_null(statement_.get(), parameter));
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    connection_.fail(code);
}

void Statement::finish() {
    while (step()) {
    }
    reset();
}

void Statement::reset() {
    sqlite3_reset(statement_.get());
    sqlite3_clear_bindings(statement_.get());
}

void Statement::expect_type(int column, int type, const char* words) const {
    if (sqlite3_column_type(statement_.get(), column) == type) return;
    connection_.damaged(fmt::format("column '{}' holds something else than {}",
                                    sqlite3_column_name(statement_.get(), column), words));
}

std::int64_t Statement::integer(int column) const {
    expect_type(column, SQLITE_INTEGER, "a whole number");
    return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
    expect_type(column, SQLITE_FLOAT, "a number");
    return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
    expect_type(column, SQLITE_TEXT, "text");
    const auto* bytes = sqlite3_column_text(statement_.get(), column);
    const int count = sqlite3_column_bytes(statement_.get(), column);
    return {reinterpret_cast<const char*>(bytes), std::size_t(count)};
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

Transaction::Transaction(const Connection& connection, Kind kind) : connection_(connection) {
    // A writer takes its lock at once: two that both read first could each wait for the other.
    connection.run(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
    // Where an error has undone it already, this fails and changes nothing.
    if (open_) sqlite3_exec(connection_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
    connection_.run("COMMIT");
    open_ = false;
}

}  // namespace lodbench::trend
