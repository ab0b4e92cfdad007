#pragma once
// Equal accuracy, equal cost: for each method the knob value at which a measured quantity meets a
// target, then all methods flown there, interleaved.

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

/// Where a search stands.
struct SearchPlace {
    std::string method;
    int method_number = 1, method_count = 1;  ///< of those with a knob
    int probe = 1, most_probes = 1;           ///< of this method's search
    double fraction = 0;                      ///< of the probe's flight
    /// Of all searches, if each needs every probe that it may have. Nothing before one was flown.
    std::optional<double> most_left_s;
};

/// Callbacks of the search, beside those of the campaign after it.
class SearchObserver {
public:
    SearchObserver() = default;
    virtual ~SearchObserver() = default;
    SearchObserver(const SearchObserver&) = delete;
    SearchObserver& operator=(const SearchObserver&) = delete;
    /// Some times a second while a probe is flown.
    virtual void flying(const SearchPlace& place) = 0;
    /// Each probe as it was measured; `failure` says why it gave nothing.
    virtual void probed(const SearchPlace& place, const MatchedMethod& method, const Probe& probe,
                        const std::string& failure) = 0;
};

/// Searches, at most `most_probes` a method, each probe a run of its own under <out>/search, then
/// flies what was found into <out>, and writes <out>/match.json. The request names one scenario, or
/// none for the demo. Probes and final flights measure the same frames: of those that the economy
/// names, the final flights keep the ones that are measured without it. Throws InputError for a
/// request that sets a knob that is to be found, or for a folder that is in use; EnvironmentError
/// as run_campaign.
[[nodiscard]] MatchOutcome match(const RunRequest& request, const results::MatchTarget& target,
                                 int most_probes, const std::filesystem::path& program,
                                 CampaignObserver& observer, SearchObserver& search);

/// As match.json holds it.
[[nodiscard]] results::MatchRecord match_record(const results::MatchTarget& target,
                                                const std::vector<MatchedMethod>& methods);

}  // namespace lodbench::run
