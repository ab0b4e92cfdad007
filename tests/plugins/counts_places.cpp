// Not broken: its counter tells from how many places it was asked to select.

#include <set>
#include <utility>

#include "quiet_method.h"

namespace {

class CountsPlaces : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void select(const lodbench::Camera& camera, const lodbench::Clock& clock) override {
        places_.emplace(camera.position.x, camera.position.y);
        moments_.insert(clock.frame);
    }
    [[nodiscard]] lodbench::Counters counters() const override {
        return {{"places_so_far", double(places_.size())},
                {"moments_so_far", double(moments_.size())}};
    }

private:
    std::set<std::pair<double, double>> places_;
    std::set<std::int64_t> moments_;
};

}  // namespace

QUIET_PLUGIN(CountsPlaces, "counts-places");
