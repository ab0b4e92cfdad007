#include <csignal>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    // Raised rather than dereferenced: undefined behaviour promises no signal.
    void draw(const lodbench::View&) override { std::raise(SIGSEGV); }
};

}  // namespace

QUIET_PLUGIN(Broken, "segfaults");
