#include "trend/database.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "api/error.h"
#include "trend/read_history.h"
#include "trend/sqlite.h"

namespace lodbench::trend {

namespace {

constexpr std::int64_t kApplication = 0x4C6F5472;  // "LoTr"

// STRICT: a column holds what it says. Values stand in the order in which a series is read.
constexpr const char* kTables[] = {
    "CREATE TABLE run (id INTEGER PRIMARY KEY, run_id TEXT NOT NULL UNIQUE, started TEXT NOT NULL, "
    "commit_id TEXT NOT NULL, tool_version TEXT NOT NULL, folder TEXT NOT NULL, "
    "context TEXT NOT NULL) STRICT",
    "CREATE TABLE series (id INTEGER PRIMARY KEY, scenario TEXT NOT NULL, flight TEXT NOT NULL, "
    "method TEXT NOT NULL, params TEXT NOT NULL, machine TEXT NOT NULL, "
    "UNIQUE (scenario, flight, method, params, machine)) STRICT",
    // Few: what is deterministic stays the same from run to run.
    "CREATE TABLE facts (id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE) STRICT",
    "CREATE TABLE cell (series INTEGER NOT NULL REFERENCES series, run INTEGER NOT NULL REFERENCES "
    "run, repetition INTEGER NOT NULL, name TEXT NOT NULL, status TEXT NOT NULL, "
    "checksum TEXT NOT NULL, facts INTEGER REFERENCES facts, "
    "PRIMARY KEY (series, run, repetition)) STRICT, WITHOUT ROWID",
    "CREATE TABLE figure (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT",
    "CREATE TABLE value (series INTEGER NOT NULL REFERENCES series, figure INTEGER NOT NULL "
    "REFERENCES figure, run INTEGER NOT NULL REFERENCES run, repetition INTEGER NOT NULL, "
    "value REAL NOT NULL, PRIMARY KEY (series, figure, run, repetition)) STRICT, WITHOUT ROWID",
};

std::int64_t number(const Connection& connection, const char* sql) {
    Statement statement(connection, sql);
    return statement.step() ? statement.integer(0) : 0;
}

/// Whether it is still empty. Throws InputError for what is no history that this version knows.
bool is_new(const Connection& connection) {
    const std::int64_t application = number(connection, "PRAGMA application_id");
    const std::int64_t version = number(connection, "PRAGMA user_version");
    const std::string file = connection.path().string();
    if (application == 0 && version == 0 &&
        number(connection, "SELECT count(*) FROM sqlite_schema") == 0) {
        return true;
    }
    if (application != kApplication || version < 1) {
        throw InputError(
            fmt::format("{}: this database is of another program, not of `lodbench "
                        "trend`; name another with --db",
                        file));
    }
    if (version > kDatabaseVersion) {
        throw InputError(fmt::format(
            "{}: this database is of schema {}, and this lodbench knows none above {}; use the "
            "lodbench that wrote it, or name another with --db",
            file, version, kDatabaseVersion));
    }
    return false;
}

void make_tables(const Connection& connection) {
    for (const char* table : kTables) connection.run(table);
    connection.run(fmt::format("PRAGMA application_id = {}", kApplication).c_str());
    connection.run(fmt::format("PRAGMA user_version = {}", kDatabaseVersion).c_str());
}

/// Adds the cells of one run, within a transaction.
class Adding {
public:
    Adding(const Connection& connection, const RunEntry& run)
        : connection_(connection), entry_(run), run_(run_row()) {}

    void add(const CellEntry& cell) {
        const std::int64_t series = series_row(cell.series);
        if (is_known(cell, series)) {
            ++added_.known;
            return;
        }
        insert_cell_.bind(1, series).bind(2, run_).bind(3, std::int64_t(cell.repetition));
        insert_cell_.bind(4, cell.name).bind(5, cell.status).bind(6, cell.checksum);
        if (cell.facts.empty()) {
            insert_cell_.bind_null(7);
        } else {
            insert_cell_.bind(7, facts_row(cell.facts));
        }
        insert_cell_.finish();
        for (const auto& [name, value] : cell.figures) {
            insert_value_.bind(1, series).bind(2, figure_row(name)).bind(3, run_);
            insert_value_.bind(4, std::int64_t(cell.repetition)).bind(5, value).finish();
        }
        ++added_.cells;
    }

    [[nodiscard]] Added added() const { return added_; }

private:
    /// The row that `find` finds, else a new one by `insert`; both are bound already.
    std::int64_t row(Statement& find, Statement& insert) {
        std::optional<std::int64_t> found;
        if (find.step()) found = find.integer(0);
        find.reset();
        if (!found) {
            insert.finish();
            found = connection_.last_row();
        } else {
            insert.reset();
        }
        return *found;
    }

    std::int64_t run_row() {
        Statement find(connection_, "SELECT id FROM run WHERE run_id = ?1");
        Statement insert(connection_,
                         "INSERT INTO run (run_id, started, commit_id, tool_version, folder, "
                         "context) VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
        find.bind(1, entry_.id);
        insert.bind(1, entry_.id).bind(2, entry_.started).bind(3, entry_.commit);
        insert.bind(4, entry_.tool_version).bind(5, entry_.folder).bind(6, entry_.context);
        return row(find, insert);
    }

    std::int64_t series_row(const SeriesName& name) {
        const std::string* texts[] = {&name.scenario, &name.flight, &name.method, &name.params,
                                      &name.machine};
        for (int i = 0; i < 5; ++i) {
            find_series_.bind(i + 1, *texts[i]);
            insert_series_.bind(i + 1, *texts[i]);
        }
        return row(find_series_, insert_series_);
    }

    std::int64_t facts_row(const std::string& text) {
        find_facts_.bind(1, text);
        insert_facts_.bind(1, text);
        return row(find_facts_, insert_facts_);
    }

    std::int64_t figure_row(const std::string& name) {
        auto known = figures_.find(name);
        if (known != figures_.end()) return known->second;
        find_figure_.bind(1, name);
        insert_figure_.bind(1, name);
        return figures_[name] = row(find_figure_, insert_figure_);
    }

    bool is_known(const CellEntry& cell, std::int64_t series) {
        find_cell_.bind(1, series).bind(2, run_).bind(3, std::int64_t(cell.repetition));
        const bool known = find_cell_.step();
        const std::string name = known ? find_cell_.text(0) : "";
        const std::string checksum = known ? find_cell_.text(1) : "";
        find_cell_.reset();
        if (known && (name != cell.name || checksum != cell.checksum)) {
            throw InputError(fmt::format(
                "{}: of run {} ({}) this history has another record of cell '{}', added as '{}'; "
                "one run gives a cell once: name the folder that was added before, or another "
                "database with --db",
                connection_.path().string(), entry_.id, entry_.folder, cell.name, name));
        }
        return known;
    }

    const Connection& connection_;
    const RunEntry& entry_;
    Statement find_series_{connection_,
                           "SELECT id FROM series WHERE scenario = ?1 AND flight = ?2 AND method = "
                           "?3 AND params = ?4 AND machine = ?5"};
    Statement insert_series_{connection_,
                             "INSERT INTO series (scenario, flight, method, params, machine) "
                             "VALUES (?1, ?2, ?3, ?4, ?5)"};
    Statement find_facts_{connection_, "SELECT id FROM facts WHERE text = ?1"};
    Statement insert_facts_{connection_, "INSERT INTO facts (text) VALUES (?1)"};
    Statement find_figure_{connection_, "SELECT id FROM figure WHERE name = ?1"};
    Statement insert_figure_{connection_, "INSERT INTO figure (name) VALUES (?1)"};
    Statement find_cell_{connection_,
                         "SELECT name, checksum FROM cell WHERE series = ?1 AND run = ?2 AND "
                         "repetition = ?3"};
    Statement insert_cell_{connection_,
                           "INSERT INTO cell (series, run, repetition, name, status, checksum, "
                           "facts) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)"};
    Statement insert_value_{connection_,
                            "INSERT INTO value (series, figure, run, repetition, value) VALUES "
                            "(?1, ?2, ?3, ?4, ?5)"};
    std::map<std::string, std::int64_t> figures_;
    std::int64_t run_ = 0;
    Added added_;
};

}  // namespace

Database::Database(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
Database::~Database() = default;
Database::Database(Database&&) noexcept = default;

Database Database::for_adding(const std::filesystem::path& file) {
    return Database(std::make_unique<Connection>(file, Connection::Mode::add));
}

Database Database::for_reading(const std::filesystem::path& file) {
    return Database(std::make_unique<Connection>(file, Connection::Mode::read));
}

Database Database::in_memory() {
    return Database(std::make_unique<Connection>("memory", Connection::Mode::memory));
}

Added Database::add(const RunEntry& run) {
    Transaction transaction(*connection_, Transaction::Kind::write);
    if (is_new(*connection_)) make_tables(*connection_);
    Added added;
    {
        Adding adding(*connection_, run);
        for (const CellEntry& cell : run.cells) adding.add(cell);
        added = adding.added();
    }
    transaction.commit();
    return added;
}

History Database::read() const {
    Transaction transaction(*connection_, Transaction::Kind::read);
    History history = is_new(*connection_) ? History{} : read_history(*connection_);
    history.file = connection_->path().string();
    return history;
}

}  // namespace lodbench::trend
