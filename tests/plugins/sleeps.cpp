// Holds its process up: 0.4 s a frame in which no time of the CPU is spent.

#include <chrono>
#include <thread>

#include "quiet_method.h"

namespace {

class Sleeps : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void select(const lodbench::Camera&, const lodbench::Clock&) override {
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
    }
};

}  // namespace

QUIET_PLUGIN(Sleeps, "sleeps");
