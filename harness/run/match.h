#pragma once
// Equal accuracy, equal cost: for each method the knob value at which a measured quantity meets a
// target, then all methods flown there, interleaved.

#include <json/value.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "report/trade.h"
#include "run/campaign.h"
#include "run/knob.h"

namespace lodbench::run {

/// What is to be equal.
struct MatchTarget {
    enum class Quantity { pixel_error, triangles, frame_ms };
    Quantity quantity = Quantity::pixel_error;
    report::ErrorMetric metric = report::ErrorMetric::p999;  ///< of the pixel error
    double value = 1;         ///< pixels, triangles, milliseconds; > 0
    double tolerance = 0.05;  ///< ratio, in (0, 1)
    int most_probes = 16;

    /// "P99.9 of the pixel error = 1 px"
    [[nodiscard]] std::string words() const;
    /// The quantity in a cell's record: mean over the flight where there is one value a frame.
    [[nodiscard]] std::optional<double> measured(const Json::Value& cell) const;
};

/// One method's search. Without a knob it is flown as it is, and `search` is empty.
struct MatchedMethod {
    std::string method;
    std::optional<Knob> knob;
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

/// Searches, each probe a run of its own under <out>/search, then flies what was found into
/// <out>, and writes <out>/match.json. The request names one scenario, or none for the demo. Throws
/// InputError for a request that sets a knob that is to be found, or for a folder that is in use;
/// EnvironmentError as run_campaign.
[[nodiscard]] MatchOutcome match(const RunRequest& request, const MatchTarget& target,
                                 const std::filesystem::path& program, CampaignObserver& observer,
                                 const ProbeObserver& probed);

/// The object of match.json.
[[nodiscard]] Json::Value to_json(const MatchTarget& target,
                                  const std::vector<MatchedMethod>& methods);

}  // namespace lodbench::run
