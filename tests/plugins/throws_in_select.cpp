#include <stdexcept>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void select(const lodbench::Camera&, const lodbench::Clock&) override {
        throw std::runtime_error("no tile left");
    }
};

}  // namespace

QUIET_PLUGIN(Broken, "throws-in-select");
