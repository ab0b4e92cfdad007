// The a-priori errors: recursion (rpcs) against level by level (ppcs), and ppcs against the mere
// copy of the bytes that it must move. Layout of Loeffler 2010, table 1.

#include <fmt/format.h>
#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "benchmarks.h"
#include "common/leb_errors.h"
#include "common/leb_row_kernels.h"
#include "terrain/height_field.h"

namespace lodbench::benchmarks {
namespace {

using namespace common;

/// Floats on huge pages where the system gives them, as LebGrid's vertices are.
class Floats {
public:
    Floats(std::size_t count, float value) {
        constexpr std::size_t kHugePage = std::size_t(2) << 20;
        const std::size_t bytes = (count * sizeof(float) + kHugePage - 1) / kHugePage * kHugePage;
        void* memory = std::aligned_alloc(kHugePage, bytes);
        if (memory == nullptr) throw std::bad_alloc();
        madvise(memory, bytes, MADV_HUGEPAGE);
        floats_.reset(static_cast<float*>(memory));
        std::fill_n(floats_.get(), count, value);
    }
    [[nodiscard]] float* data() const { return floats_.get(); }

private:
    struct Free {
        void operator()(float* floats) const { std::free(floats); }
    };
    std::unique_ptr<float[], Free> floats_;
};

/// 4 bytes in and 8 out a sample.
class Copy {
public:
    explicit Copy(std::size_t samples)
        : samples_(samples), in_(samples, 1.0F), out_(2 * samples, 0.0F) {}
    void run() {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples_, std::size_t(1) << 18),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              const float* __restrict in = in_.data();
                              float* __restrict out = out_.data();
                              for (std::size_t i = range.begin(); i != range.end(); ++i) {
                                  out[2 * i] = in[i];
                                  out[2 * i + 1] = in[i];
                              }
                          });
    }

private:
    std::size_t samples_;
    Floats in_, out_;
};

template <typename Work>
double best_of(int repetitions, const Work& work) {
    double best = 1e300;
    for (int i = 0; i < repetitions; ++i) best = std::min(best, seconds_of(work));
    return best;
}

}  // namespace

void errors_cost(const Options& options) {
    const std::unique_ptr<terrain::HeightField> whole = terrain::load_terrain(options.source());
    const int cores =
        int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    fmt::print("errors, {}, midpoint, vector code {}; ns a sample, best of {}\n",
               whole->info().name, row_kernels().instruction_set, options.repetitions);
    fmt::print(
        "  size   cores    rpcs  ppcs plain    ppcs    copy  rpcs/ppcs  ppcs/copy  ppcs ms\n");
    std::vector<double> per_sample;
    for (int size = 1025; size <= options.size; size = 2 * size - 1) {
        if (size > std::max(whole->info().rows, whole->info().columns)) break;
        LebGrid grid(*north_west_corner(*whole, size));
        const double ns = 1e9 / double(grid.vertex_count());
        // Recursion has no parallel form: one time stands for any number of cores.
        const double rpcs = ns * best_of(options.repetitions, [&] {
                                compute_errors_recursively(grid, ErrorKind::midpoint);
                            });
        for (int threads = 1; threads <= cores; threads *= 2) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                            std::size_t(threads));
            const double plain = ns * best_of(options.repetitions, [&] {
                                     compute_errors_by_level_plain(grid, ErrorKind::midpoint);
                                 });
            const double ppcs = ns * best_of(options.repetitions, [&] {
                                    compute_errors_by_level(grid, ErrorKind::midpoint);
                                });
            double copied = 0;
            {
                Copy copy(grid.vertex_count());
                copied = ns * best_of(options.repetitions, [&] { copy.run(); });
            }
            fmt::print("  {:5} {:6} {:8.1f} {:11.2f} {:7.2f} {:7.2f} {:9.1f}x {:9.2f}x {:8.1f}\n",
                       grid.size(), threads, rpcs, plain, ppcs, copied, rpcs / ppcs, ppcs / copied,
                       ppcs / ns * 1e3);
            std::fflush(stdout);
            if (threads == 1) per_sample.push_back(ppcs);
        }
    }
    if (per_sample.size() > 1) {
        const auto [low, high] = std::minmax_element(per_sample.begin(), per_sample.end());
        fmt::print(
            "  L3, linear in samples: ns a sample on one core vary by a factor of {:.2f} over a "
            "factor of {} in samples\n",
            *high / *low, 1 << 2 * (per_sample.size() - 1));
    }
}

}  // namespace lodbench::benchmarks
