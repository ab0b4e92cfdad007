#include <unistd.h>

#include <cstdlib>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override {
        static const int once = std::atexit([] {
            for (;;) pause();
        });
        (void)once;
    }
};

}  // namespace

QUIET_PLUGIN(Broken, "hangs-at-exit");
