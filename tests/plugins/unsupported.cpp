#include "quiet_method.h"

namespace {

class Unsupported final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void upload(lodbench::gl::Device&) override {
        throw lodbench::UnsupportedError("no second moon in this sky");
    }
};

}  // namespace

QUIET_PLUGIN(Unsupported, "unsupported");
