#pragma once
// A search for knob values as a person sees it.

#include "cli/campaign_options.h"
#include "run/match.h"

namespace lodbench::cli {

/// A probe is a line when it is measured; on a terminal one is redrawn while it flies.
class SearchProgress final : public run::SearchObserver {
public:
    explicit SearchProgress(Progress& progress) : progress_(progress) {}
    void flying(const run::SearchPlace& place) override;
    void probed(const run::SearchPlace& place, const run::MatchedMethod& method,
                const run::Probe& probe, const std::string& failure) override;

private:
    Progress& progress_;
};

}  // namespace lodbench::cli
