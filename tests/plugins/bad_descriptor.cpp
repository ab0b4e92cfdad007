// A default outside its range.

#include "quiet_method.h"

namespace {

constexpr lodbench::ParamSpec kParams[] = {lodbench::real_param("tau", 0, 0.25, 16, "pixels")};

constexpr lodbench::MethodDescriptor bad() {
    lodbench::MethodDescriptor method = quiet_descriptor<QuietMethod>("bad-descriptor");
    method.params = kParams;
    method.param_count = 1;
    return method;
}

constexpr lodbench::MethodDescriptor kMethods[] = {bad()};

}  // namespace

LODBENCH_PLUGIN(kMethods);
