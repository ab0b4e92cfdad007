#pragma once
// Equal accuracy, equal cost: for each method the knob value at which a measured quantity meets a
// target, then all methods flown there, interleaved.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/match.h"
#include "run/campaign.h"
#include "run/knob.h"

namespace lodbench::run {

/// One method's search. Without a knob it is flown as it is, and `search` is empty.
struct MatchedMethod {
    std::string method;
    std::optional<Knob> knob;
    bool asynchronous = false;  ///< where it meets the target it is flown three times: the median
    SearchResult search;
    std::string failure;  ///< why a probe gave nothing; "" when none did
};

struct MatchOutcome {
    std::vector<MatchedMethod> methods;
    CampaignOutcome campaign;  ///< at the values that were found
};

/// Told of each probe as it was measured.
using ProbeObserver = std::function<void(const MatchedMethod& method, const Probe& probe,
                                         const std::string& failure)>;

/// Searches, at most `most_probes` a method, each probe a run of its own under <out>/search, then
/// flies what was found into <out>, and writes <out>/match.json. The request names one scenario, or
/// none for the demo. Throws InputError for a request that sets a knob that is to be found, or for
/// a folder that is in use; EnvironmentError as run_campaign.
[[nodiscard]] MatchOutcome match(const RunRequest& request, const results::MatchTarget& target,
                                 int most_probes, const std::filesystem::path& program,
                                 CampaignObserver& observer, const ProbeObserver& probed);

/// As match.json holds it.
[[nodiscard]] results::MatchRecord match_record(const results::MatchTarget& target,
                                                const std::vector<MatchedMethod>& methods);

}  // namespace lodbench::run
