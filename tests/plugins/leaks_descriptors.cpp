#include <fcntl.h>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override {
        while (open("/dev/null", O_RDONLY) >= 0) {
        }
    }
};

}  // namespace

QUIET_PLUGIN(Broken, "leaks-descriptors");
