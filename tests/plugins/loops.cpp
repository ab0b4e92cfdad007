#include <atomic>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override {
        for (std::atomic<bool> forever{true}; forever.load();) {
        }
    }
};

}  // namespace

QUIET_PLUGIN(Broken, "loops");
