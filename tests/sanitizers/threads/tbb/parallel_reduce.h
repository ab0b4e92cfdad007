#pragma once
// See parallel_for.h beside it.

#include <mutex>

#include "tbb/parallel_for.h"

namespace tbb {

template <typename T, typename Value, typename Body, typename Join>
Value parallel_reduce(const blocked_range<T>& range, const Value& identity, const Body& body,
                      const Join& join) {
    std::mutex mutex;
    Value total = identity;
    parallel_for(range, [&](const blocked_range<T>& part) {
        const Value value = body(part, identity);
        const std::lock_guard lock(mutex);
        total = join(total, value);
    });
    return total;
}

}  // namespace tbb
