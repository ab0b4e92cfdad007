// Allowed, and must not disturb the listing.

#include <cstdio>

#include "quiet_method.h"

namespace {

struct Prints {
    Prints() { std::puts("{\"methods\": \"hello from a constructor\"}"); }
} const prints;

}  // namespace

QUIET_PLUGIN(QuietMethod, "constructor-prints");
