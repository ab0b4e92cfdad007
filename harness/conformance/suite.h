#pragma once
// Runs checks, each in a process of its own, and says what came of them.

#include <string>
#include <vector>

#include "conformance/check.h"

namespace lodbench::conformance {

enum class Verdict { passed, failed, skipped };
[[nodiscard]] const char* name_of(Verdict verdict);

struct CheckReport {
    std::string check;
    Verdict verdict = Verdict::failed;
    std::string reason;  ///< empty when passed
    double seconds = 0;
};

/// Runs one check in a child process. A child that dies or exceeds the time limit has failed; an
/// environment without the means (no GL) skips. `time_factor` stretches the limit, for slow
/// machines and sanitizers.
[[nodiscard]] CheckReport run_check(const Check& check, const Subject& subject,
                                    double time_factor = 1);

/// The check of that name. Throws InputError that lists the names.
[[nodiscard]] const Check& find_check(const std::string& name);

}  // namespace lodbench::conformance
