#include <sys/resource.h>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override {
        const rlimit none{0, 0};
        setrlimit(RLIMIT_NOFILE, &none);
    }
};

}  // namespace

QUIET_PLUGIN(Broken, "lowers-limits");
