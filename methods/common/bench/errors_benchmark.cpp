// The a-priori errors: recursion (rpcs) against level by level, as the paper states it (plain) and
// as the methods here use it (ours: streamed, in vector code), and ours against the mere copy of
// the bytes that it must move. Layout of Loeffler 2010, table 1; its claims are judged on the plain
// form.

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
#include <string>
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

/// ns a sample.
struct Row {
    int cores;
    double rpcs, plain, ours;
};

/// The paper's claims about table 1, by what these rows say.
void judge(const std::vector<Row>& rows) {
    const auto range = [&](bool one_core, auto figure) {
        double low = 1e300, high = 0;
        for (const Row& row : rows) {
            if ((row.cores == 1) != one_core) continue;
            low = std::min(low, figure(row));
            high = std::max(high, figure(row));
        }
        return high == 0 ? std::string("not measured") : fmt::format("{:.1f} to {:.1f}", low, high);
    };
    const auto gain = [](const Row& row) { return row.rpcs / row.plain; };
    const bool faster =
        std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.plain < row.rpcs; });
    fmt::print("  L1, faster than recursion in every case: {}\n",
               faster ? "holds" : "does not hold");
    fmt::print("  L2 and L8, rpcs/plain: {} on one core (claimed 4 to 5), {} on more (10 to 12)\n",
               range(true, gain), range(false, gain));
    double low = 1e300, high = 0, best = 0;
    for (const Row& row : rows) {
        best = std::max(best, gain(row));
        if (row.cores != 1) continue;
        low = std::min(low, row.plain);
        high = std::max(high, row.plain);
    }
    fmt::print("  L3, linear in samples: plain on one core varies by a factor of {:.2f} a sample\n",
               high / low);
    fmt::print("  L7, by several orders of magnitude (100 or more): {}, {:.1f} at most\n",
               best >= 100 ? "holds" : "does not hold", best);
    const Row& last = rows.back();
    constexpr double kFrame = 1e9 / 60;  // ns
    fmt::print(
        "  L17, on the fly: in a 60th of a second the errors of {:.2f} million samples, ours "
        "{:.1f}\n",
        kFrame / last.plain / 1e6, kFrame / last.ours / 1e6);
}

template <typename Work>
double best_of(int repetitions, const Work& work) {
    double best = 1e300;
    for (int i = 0; i < repetitions; ++i) best = std::min(best, seconds_of(work));
    return best;
}

}  // namespace

void errors_benchmark(const Options& options) {
    const std::unique_ptr<terrain::HeightField> whole = terrain::load_terrain(options.source());
    const int cores =
        int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    fmt::print("errors, {}, midpoint, vector code {}; ns a sample, best of {}\n",
               whole->info().name, row_kernels().instruction_set, options.repetitions);
    fmt::print("  size   cores |    rpcs   plain  rpcs/plain |    ours  rpcs/ours  ours/copy\n");
    std::vector<Row> rows;
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
            const double ours = ns * best_of(options.repetitions, [&] {
                                    compute_errors_by_level(grid, ErrorKind::midpoint);
                                });
            double copied = 0;
            {
                Copy copy(grid.vertex_count());
                copied = ns * best_of(options.repetitions, [&] { copy.run(); });
            }
            fmt::print("  {:5} {:6} | {:7.1f} {:7.2f} {:10.1f}x | {:7.2f} {:9.1f}x {:9.2f}x\n",
                       grid.size(), threads, rpcs, plain, rpcs / plain, ours, rpcs / ours,
                       ours / copied);
            std::fflush(stdout);
            rows.push_back({threads, rpcs, plain, ours});
        }
    }
    judge(rows);
}

}  // namespace lodbench::benchmarks
