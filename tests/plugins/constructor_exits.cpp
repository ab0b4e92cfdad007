#include <cstdlib>

#include "quiet_method.h"

namespace {

struct Exits {
    Exits() { std::exit(0); }
} const exits;

}  // namespace

QUIET_PLUGIN(QuietMethod, "constructor-exits");
