// As code that was compiled with -ffast-math: loading it changes the floating-point modes.

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "quiet_method.h"

namespace {

__attribute__((constructor)) void flush_to_zero() {
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

}  // namespace

QUIET_PLUGIN(QuietMethod, "flushes-when-loaded");
