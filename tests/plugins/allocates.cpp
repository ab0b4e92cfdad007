#include <cstring>
#include <vector>

#include "quiet_method.h"

namespace {

class Broken final : public QuietMethod {
public:
    using QuietMethod::QuietMethod;
    void draw(const lodbench::View&) override {
        constexpr std::size_t kBlock = 16 << 20;
        for (;;) std::memset(blocks_.emplace_back(kBlock).data(), 1, kBlock);
    }

private:
    std::vector<std::vector<char>> blocks_;
};

}  // namespace

QUIET_PLUGIN(Broken, "allocates");
