#include "run/shared_signs.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <utility>

#include "api/error.h"

namespace lodbench::run {

namespace {

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

std::shared_ptr<VitalSigns> map_signs(int descriptor) {
    const int flags = descriptor < 0 ? MAP_SHARED | MAP_ANONYMOUS : MAP_SHARED;
    void* page = mmap(nullptr, sizeof(VitalSigns), PROT_READ | PROT_WRITE, flags, descriptor, 0);
    if (page == MAP_FAILED) {
        throw EnvironmentError(fmt::format("cannot map shared memory: {}", std::strerror(errno)));
    }
    VitalSigns* signs = descriptor < 0 ? new (page) VitalSigns : static_cast<VitalSigns*>(page);
    return {signs, [](VitalSigns* mapped) { munmap(mapped, sizeof(VitalSigns)); }};
}

HangWatch::HangWatch(std::shared_ptr<const VitalSigns> signs, double limit_s)
    : signs_(std::move(signs)), limit_s_(limit_s), since_s_(now_s()) {}

Call HangWatch::hung_in() {
    if (const std::uint64_t beats = signs_->beats.load(); beats != beats_) {
        beats_ = beats;
        since_s_ = now_s();
    }
    return now_s() - since_s_ > limit_s_ ? signs_->call.load() : Call::none;
}

}  // namespace lodbench::run
