// Methods whose answers are of no use.

#include <cmath>
#include <limits>
#include <string>

#include "quiet_method.h"

namespace {

lodbench::Method* create_nothing(const lodbench::Params&, lodbench::CreateError*) noexcept {
    return nullptr;
}

template <lodbench::Counters (*kAnswer)()>
class Answers final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    [[nodiscard]] lodbench::Counters counters() const override { return kAnswer(); }
};

lodbench::Counters many() {
    lodbench::Counters counters;
    for (int i = 0; i < 5000; ++i) counters.emplace_back("counter_" + std::to_string(i), i);
    return counters;
}

constexpr lodbench::MethodDescriptor no_method() {
    lodbench::MethodDescriptor descriptor = quiet_descriptor<QuietMethod>("creates-nothing");
    descriptor.create = create_nothing;
    return descriptor;
}

constexpr lodbench::MethodDescriptor kAnswers[] = {
    no_method(),
    quiet_descriptor<Answers<[]() -> lodbench::Counters {
        return {{"count", NAN}};
    }>>("counts-nan"),
    quiet_descriptor<Answers<[]() -> lodbench::Counters {
        return {{"count", INFINITY}};
    }>>("counts-without-end"),
    quiet_descriptor<Answers<[]() -> lodbench::Counters {
        return {{std::string(1 << 20, 'n'), 1}};
    }>>("counts-with-a-huge-name"),
    quiet_descriptor<Answers<[]() -> lodbench::Counters {
        return {{"\x1b[2J\xff\n,\"", 1}, {"", 2}, {"", 3}};
    }>>("counts-with-bytes-for-names"),
    quiet_descriptor<Answers<many>>("counts-thousands"),
};

}  // namespace

LODBENCH_PLUGIN(kAnswers);
