#pragma once
// run.json of a campaign: as it is made, and what a campaign that is taken up must have in common
// with the one that began.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/cell.h"
#include "results/run_record.h"
#include "run/plan.h"

namespace lodbench::run {

/// Of a whole campaign's plan: the shard that is asked for is kept of it afterwards.
[[nodiscard]] results::RunRecord make_run_record(const RunRequest& request, const Plan& plan,
                                                 const std::vector<PluginListing>& plugins);

/// Of a file that a scenario names.
[[nodiscard]] std::string checksum_of_file(const std::filesystem::path& file);

/// A campaign that is taken up: what it is resumed with against what it began with. Every member
/// throws InputError that names run.json, both values and the remedy.
class Resumption {
public:
    /// Both outlive it. `folder` is that of the results.
    Resumption(const results::RunRecord& began, const std::filesystem::path& folder)
        : began_(began), folder_(folder), file_((folder / "run.json").string()) {}

    /// One program, the same part of the campaign, the same pause between cells.
    void expect_same_terms(const RunRequest& request) const;
    /// The recorded flights, of which a scenario's text says only where they lie.
    void expect_same_flights() const;
    /// What is asked for beside --resume: it is flown as it was planned, `plan`.
    void expect_same_plan(const RunRequest& request, const Plan& plan,
                          const std::vector<PluginListing>& plugins) const;

private:
    void expect_same_shard(const RunRequest& request) const;
    void expect_same_cool_down(const RunRequest& request) const;
    void expect_same_build() const;

    const results::RunRecord& began_;
    const std::filesystem::path& folder_;
    std::string file_;
};

/// Throws InputError where the flight's checksum is not that which it had when the run began ("":
/// not known).
void expect_same_flight(const std::filesystem::path& flight, const std::string& began);

/// What a cell saw of the driver must be what the first cell saw. Throws InputError.
void expect_same_renderer(const std::optional<results::GlContext>& began,
                          const results::GlContext& seen);

/// Cells of one run compare methods on one terrain: a file that changed between them, the terrain's
/// or the plugin's, ends the run. Throws InputError.
void expect_same_input(const std::vector<results::CellRecord>& cells,
                       const results::CellRecord& record);

}  // namespace lodbench::run
