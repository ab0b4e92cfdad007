#pragma once
// SQLite as the history needs it: a file that may hold anything, errors in words.

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace lodbench::trend {

/// An open database. Only prepared statements run on it; what a hostile file brings along (views,
/// triggers, functions in its schema) does not.
class Connection {
public:
    enum class Mode { add, read, memory };
    /// `add` makes the file where there is none. Throws InputError for what is no plain file, for
    /// `read` also where there is none; EnvironmentError where it cannot be opened. Whether it is a
    /// database is seen at its first use.
    Connection(std::filesystem::path path, Mode mode);

    [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// A statement without parameters and results.
    void run(const char* sql) const;
    [[nodiscard]] std::int64_t last_row() const { return sqlite3_last_insert_rowid(handle()); }

    /// Turns SQLite's last error on this connection into InputError (no database, a damaged one),
    /// base::DiskFullError or EnvironmentError.
    [[noreturn]] void fail(int code) const;
    /// Throws InputError: what was read is not what a history holds.
    [[noreturn]] void damaged(std::string_view what) const;

private:
    void configure() const;
    struct Close {
        void operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }
    };
    std::filesystem::path path_;
    std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement; it may be bound and run again after `reset`. The connection outlives it.
class Statement {
public:
    Statement(const Connection& connection, const char* sql);

    /// Parameters count from 1.
    Statement& bind(int parameter, std::int64_t value);
    Statement& bind(int parameter, double value);
    /// The text is copied.
    Statement& bind(int parameter, std::string_view text);
    Statement& bind_null(int parameter);

    /// Whether there is another row.
    bool step();
    /// Runs it to its end, and makes it ready to be bound again.
    void finish();
    void reset();

    /// Columns count from 0. Each throws InputError where the file holds another type.
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] bool is_null(int column) const;

private:
    void expect(int code) const;
    void expect_type(int column, int type, const char* words) const;
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    const Connection& connection_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// From construction to `commit` all or nothing; undone where `commit` is not reached.
class Transaction {
public:
    enum class Kind { read, write };
    Transaction(const Connection& connection, Kind kind);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

private:
    const Connection& connection_;
    bool open_ = true;
};

}  // namespace lodbench::trend
