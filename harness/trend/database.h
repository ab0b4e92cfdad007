#pragma once
// The history of runs: an SQLite database that many may add to.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "trend/run_record.h"

namespace lodbench::trend {

/// Of the tables below; a database of a newer one is refused.
inline constexpr int kDatabaseVersion = 1;

struct RunHead {
    std::string id, started, commit, tool_version, folder;
    std::size_t cells = 0, ok = 0;
};

/// A figure of a series, over the runs that have it: of each the median over its repetitions.
struct FigureHistory {
    std::size_t series = 0;
    std::string figure;
    std::vector<std::size_t> runs;  ///< rising indices
    std::vector<double> values;     ///< finite
};

/// What of a series does not vary from flight to flight, over its runs.
struct FactsHistory {
    std::size_t series = 0;
    std::vector<std::size_t> runs;  ///< rising indices
    /// Of each run the indices of the texts of its repetitions, which are JSON objects.
    std::vector<std::vector<std::size_t>> texts;
};

/// All that a database holds, as of one moment.
struct History {
    std::string file;           ///< for messages
    std::vector<RunHead> runs;  ///< in the order in which they began
    std::vector<SeriesName> series;
    std::vector<FigureHistory> figures;  ///< in order of series and name
    std::vector<FactsHistory> facts;     ///< in order of series
    std::vector<std::string> texts;
};

struct Added {
    std::size_t cells = 0;  ///< that the history did not have
    std::size_t known = 0;  ///< that it had
};

class Connection;

class Database {
public:
    /// In the file, which is made where there is none. Several processes may add at once: each
    /// waits for the others. Throws as `Connection`.
    static Database for_adding(const std::filesystem::path& file);
    /// Throws InputError where there is no such file.
    static Database for_reading(const std::filesystem::path& file);
    /// In memory, empty.
    static Database in_memory();
    ~Database();
    Database(Database&&) noexcept;
    Database& operator=(Database&&) = delete;

    /// Adds the cells of a run that are not there yet, all or none; a run may be added again.
    /// Throws InputError where the file is no history, is damaged or of a newer version, or where
    /// it has another record of one of the cells; base::DiskFullError and EnvironmentError where it
    /// cannot be written. Then, and when the process is killed, the file is as it was.
    Added add(const RunEntry& run);

    /// Throws InputError for what no history holds, EnvironmentError where it cannot be read.
    [[nodiscard]] History read() const;

private:
    explicit Database(std::unique_ptr<Connection> connection);
    std::unique_ptr<Connection> connection_;
};

}  // namespace lodbench::trend
