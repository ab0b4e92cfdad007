#pragma once
// A campaign: its cells one after the other, each in a process of its own, and what is on disk at
// any moment.

#include <filesystem>
#include <string>
#include <vector>

#include "results/cell.h"
#include "results/run_record.h"
#include "run/plan.h"

namespace lodbench::run {

struct CampaignOutcome;

/// Progress callbacks of a campaign.
class CampaignObserver {
public:
    CampaignObserver() = default;
    virtual ~CampaignObserver() = default;
    CampaignObserver(const CampaignObserver&) = delete;
    CampaignObserver& operator=(const CampaignObserver&) = delete;
    virtual void warned(const std::string& /*warning*/) {}
    /// Of what disturbs times.
    virtual void noisy(const std::string& /*words*/) {}
    virtual void cell_progress(const PlannedCell& /*cell*/, std::size_t /*index*/,
                               std::size_t /*count*/, double /*fraction*/) {}
    /// Some times a second while it waits before a cell.
    virtual void cooling_down(double /*left_s*/) {}
    virtual void cell_finished(const PlannedCell& /*cell*/, std::size_t /*index*/,
                               std::size_t /*count*/, const results::CellRecord& /*record*/) {}
    /// The text of summary.md, asked for at the end.
    [[nodiscard]] virtual std::string summary(const CampaignOutcome& /*outcome*/,
                                              const results::RunRecord& /*run*/) {
        return {};
    }
};

struct CampaignOutcome {
    std::filesystem::path out;
    std::vector<results::CellRecord> cells;  ///< all that stand in cells.jsonl
    std::vector<std::string> warnings;
    std::uint64_t seed = 1;
    results::RunRecord run;
    bool nothing_to_fly = false;  ///< a shard without a block: there are more shards than blocks
    std::string error;            ///< why it ended early (a full disk); "" when it did not
    /// 0, 3 or 4, as docs/manual.md says.
    [[nodiscard]] int exit_status() const;
};

/// Waits, so that the machine cools down, and tells of it. Throws Interrupted.
void cool_down(double seconds, CampaignObserver& observer);

/// Plans, or with `resume` takes up, a campaign and flies what is missing. `program` is what a
/// cell's child runs. Throws InputError or EnvironmentError before the first cell; after it,
/// whatever stops the campaign is in the outcome, and what was finished stays. Throws Interrupted
/// at any moment: what is in the folder can be resumed.
[[nodiscard]] CampaignOutcome run_campaign(const RunRequest& request,
                                           const std::filesystem::path& program,
                                           CampaignObserver& observer);

}  // namespace lodbench::run
