#include <cstdlib>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override { std::abort(); }
};

}  // namespace

QUIET_PLUGIN(Broken, "aborts");
