#pragma once
// See parallel_for.h beside it.

#include <thread>
#include <utility>
#include <vector>

namespace tbb {

class task_group {
public:
    template <typename Body>
    void run(Body body) {
        threads_.emplace_back(std::move(body));
    }
    void wait() { threads_.clear(); }

private:
    std::vector<std::jthread> threads_;
};

}  // namespace tbb
