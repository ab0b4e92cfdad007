#include <atomic>

#include "quiet_method.h"

namespace {

struct Loops {
    Loops() {
        for (std::atomic<bool> forever{true}; forever.load();) {
        }
    }
} const loops;

}  // namespace

QUIET_PLUGIN(QuietMethod, "constructor-loops");
