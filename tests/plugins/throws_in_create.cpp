#include <stdexcept>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    explicit Broken(const lodbench::Params& params) : QuietMethod(params) {
        throw std::runtime_error("the moon is in the wrong house");
    }
};

}  // namespace

QUIET_PLUGIN(Broken, "throws-in-create");
