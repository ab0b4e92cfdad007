#include <cstdio>
#include <cstdlib>

#include "quiet_method.h"

namespace {

struct Aborts {
    Aborts() {
        std::fprintf(stderr, "out of luck\n");
        std::abort();
    }
} const aborts;

}  // namespace

QUIET_PLUGIN(QuietMethod, "constructor-aborts");
