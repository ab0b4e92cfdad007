#pragma once
// See parallel_for.h beside it.

namespace tbb {

namespace this_task_arena {
inline thread_local int concurrency = 4;
[[nodiscard]] inline int max_concurrency() {
    return concurrency;
}
}  // namespace this_task_arena

/// Says how many threads there are to those who ask; loops have four all the same.
class task_arena {
public:
    explicit task_arena(int threads) : threads_(threads) {}
    template <typename Body>
    void execute(const Body& body) const {
        const int before = this_task_arena::concurrency;
        this_task_arena::concurrency = threads_;
        body();
        this_task_arena::concurrency = before;
    }

private:
    int threads_;
};

}  // namespace tbb
