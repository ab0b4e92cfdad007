#include "common/leb_row_kernels.h"

#include <cmath>

// Inlined into a function of another instruction set, a function becomes code of that set.
#define LEB_INLINE [[gnu::always_inline]] inline

namespace lodbench::common {
namespace {

LEB_INLINE void split_row(const float* __restrict in, std::ptrdiff_t stride, int pairs,
                          float* __restrict even, float* __restrict odd) {
    for (std::ptrdiff_t i = 0; i < pairs; ++i) {
        even[i] = in[2 * i * stride];
        odd[i] = in[(2 * i + 1) * stride];
    }
    even[pairs] = in[2 * std::ptrdiff_t(pairs) * stride];
}

// By value: a reference to an element keeps the loop from becoming vector code.
template <typename T>
LEB_INLINE T larger(T a, T b) {
    return a < b ? b : a;
}
template <typename T>
LEB_INLINE T largest(T a, T b, T c, T d) {
    return larger(larger(a, b), larger(c, d));
}

template <ErrorKind kind>
LEB_INLINE float saturated(double delta, float child_error) {
    if constexpr (kind == ErrorKind::accumulated) {
        return stored_above(delta + double(child_error));
    } else {
        return larger(stored_above(delta), child_error);
    }
}

/// Of the distance between vertices `height` and `child` high.
LEB_INLINE double square(double height, float child, double squared_distance) {
    const double rise = height - double(child);
    return squared_distance + rise * rise;
}

// What is written is not read in these loops: LEB_LOOP says so.
#define LEB_LOOP _Pragma("GCC ivdep")

LEB_INLINE void leaf_row(const SplitRow& row, int count) {
    const float* __restrict height = row.vertex.height;
    const float* __restrict a = row.end_a;
    const float* __restrict b = row.end_b;
    float* __restrict error = row.vertex.error;
    float* __restrict radius = row.vertex.radius;
    LEB_LOOP
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const double middle = 0.5 * (double(a[i]) + double(b[i]));
        error[i] = stored_above(std::abs(double(height[i]) - middle));
        radius[i] = 0;
    }
}

template <ErrorKind kind>
LEB_INLINE void edge_row(const SplitRow& row, const VertexRow (&child)[4], double squared_distance,
                         int count) {
    const float* __restrict height = row.vertex.height;
    const float* __restrict a = row.end_a;
    const float* __restrict b = row.end_b;
    float* __restrict error = row.vertex.error;
    float* __restrict radius = row.vertex.radius;
    const float *h0 = child[0].height, *h1 = child[1].height;
    const float *h2 = child[2].height, *h3 = child[3].height;
    const float *e0 = child[0].error, *e1 = child[1].error;
    const float *e2 = child[2].error, *e3 = child[3].error;
    const float *r0 = child[0].radius, *r1 = child[1].radius;
    const float *r2 = child[2].radius, *r3 = child[3].radius;
    LEB_LOOP
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const double h = height[i];
        const double middle = 0.5 * (double(a[i]) + double(b[i]));
        const float child_error = largest(e0[i], e1[i], e2[i], e3[i]);
        error[i] = saturated<kind>(std::abs(h - middle), child_error);
        radius[i] =
            stored_above(largest(std::sqrt(square(h, h0[i], squared_distance)) + double(r0[i]),
                                 std::sqrt(square(h, h1[i], squared_distance)) + double(r1[i]),
                                 std::sqrt(square(h, h2[i], squared_distance)) + double(r2[i]),
                                 std::sqrt(square(h, h3[i], squared_distance)) + double(r3[i])));
    }
}

template <ErrorKind kind, bool of_leaves>
LEB_INLINE void centre_row(VertexRow centre, bool falling, const float* __restrict north,
                           const float* __restrict south, const VertexRow (&child)[4],
                           double squared_y, double squared_x, int count) {
    const float* __restrict height = centre.height;
    float* __restrict error = centre.error;
    float* __restrict radius = centre.radius;
    const float *h0 = child[0].height, *h1 = child[1].height;
    const float *h2 = child[2].height, *h3 = child[3].height;
    const float *e0 = child[0].error, *e1 = child[1].error;
    const float *e2 = child[2].error, *e3 = child[3].error;
    const float *r0 = child[0].radius, *r1 = child[1].radius;
    const float *r2 = child[2].radius, *r3 = child[3].radius;
    const std::ptrdiff_t bias = falling ? 0 : 1;
    LEB_LOOP
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const double h = height[i];
        const float north_west = north[i], north_east = north[i + 1];
        const float south_west = south[i], south_east = south[i + 1];
        const bool falls = ((i + bias) & 1) == 0;
        const double middle = 0.5 * (double(falls ? north_west : north_east) +
                                     double(falls ? south_east : south_west));
        const float child_error = largest(e0[i], e1[i], e2[i], e3[i]);
        error[i] = saturated<kind>(std::abs(h - middle), child_error);
        const double s0 = square(h, h0[i], squared_y);
        const double s1 = square(h, h1[i], squared_y);
        const double s2 = square(h, h2[i], squared_x);
        const double s3 = square(h, h3[i], squared_x);
        if constexpr (of_leaves) {
            radius[i] = stored_above(std::sqrt(largest(s0, s1, s2, s3)));
        } else {
            radius[i] =
                stored_above(largest(std::sqrt(s0) + double(r0[i]), std::sqrt(s1) + double(r1[i]),
                                     std::sqrt(s2) + double(r2[i]), std::sqrt(s3) + double(r3[i])));
        }
    }
}

constexpr ErrorKind kMidpoint = ErrorKind::midpoint;
constexpr ErrorKind kAccumulated = ErrorKind::accumulated;

// The same five functions for one instruction set.
#define LEB_ROW_KERNELS(name, attributes, text)                                                  \
    namespace name {                                                                             \
    attributes void split(const float* in, std::ptrdiff_t stride, int pairs, float* even,        \
                          float* odd) {                                                          \
        if (stride == 1) return split_row(in, 1, pairs, even, odd);                              \
        if (stride == 3) return split_row(in, 3, pairs, even, odd);                              \
        split_row(in, stride, pairs, even, odd);                                                 \
    }                                                                                            \
    attributes void leaves(const SplitRow& row, int count) {                                     \
        leaf_row(row, count);                                                                    \
    }                                                                                            \
    attributes void edges(ErrorKind kind, const SplitRow& row, const VertexRow (&child)[4],      \
                          double squared_distance, int count) {                                  \
        if (kind == kMidpoint) return edge_row<kMidpoint>(row, child, squared_distance, count);  \
        edge_row<kAccumulated>(row, child, squared_distance, count);                             \
    }                                                                                            \
    template <bool of_leaves>                                                                    \
    attributes void centres(ErrorKind kind, VertexRow centre, bool falling, const float* north,  \
                            const float* south, const VertexRow (&child)[4], double squared_y,   \
                            double squared_x, int count) {                                       \
        if (kind == kMidpoint) {                                                                 \
            return centre_row<kMidpoint, of_leaves>(centre, falling, north, south, child,        \
                                                    squared_y, squared_x, count);                \
        }                                                                                        \
        centre_row<kAccumulated, of_leaves>(centre, falling, north, south, child, squared_y,     \
                                            squared_x, count);                                   \
    }                                                                                            \
    constexpr RowKernels kKernels = {text, split, leaves, edges, centres<false>, centres<true>}; \
    }

LEB_ROW_KERNELS(plain, , "baseline")
#if defined(__x86_64__)
LEB_ROW_KERNELS(avx2, [[gnu::target("avx2")]], "AVX2")
LEB_ROW_KERNELS(avx512, [[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]], "AVX-512")
#endif

}  // namespace

RowKernelList all_row_kernels() {
    RowKernelList list{{&plain::kKernels, nullptr, nullptr}, 1};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) list.kernels[list.count++] = &avx2::kKernels;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
        list.kernels[list.count++] = &avx512::kKernels;
    }
#endif
    return list;
}

const RowKernels& row_kernels() {
    const RowKernelList list = all_row_kernels();
    return *list.kernels[list.count - 1];
}

}  // namespace lodbench::common
