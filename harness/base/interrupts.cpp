#include "base/interrupts.h"

#include <signal.h>

namespace lodbench::base {

namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};

volatile sig_atomic_t noted = 0;

bool is_ignored(int number) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    return action.sa_handler == SIG_IGN;
}

void note(int /*number*/) {
    noted = 1;
    for (const int number : kSignals) {
        if (!is_ignored(number)) signal(number, SIG_DFL);
    }
}

}  // namespace

void heed_interrupts() {
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;  // what is being written is written to its end
    for (const int number : kSignals) {
        if (!is_ignored(number)) sigaction(number, &action, nullptr);
    }
}

bool interrupted() {
    return noted != 0;
}

}  // namespace lodbench::base
