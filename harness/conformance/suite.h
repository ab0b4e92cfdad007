#pragma once
// Runs checks, each in a process of its own, and says what came of them.

#include <string>
#include <vector>

#include "conformance/check.h"

namespace lodbench::conformance {

enum class Verdict { passed, warned, failed, skipped };
[[nodiscard]] const char* name_of(Verdict verdict);

struct CheckReport {
    std::string check;
    Verdict verdict = Verdict::failed;
    std::string reason;  ///< empty when passed
    double seconds = 0;
    std::string hung_in;  ///< the call that did not come back; "" where none did
};

/// Runs one check in a child process for at most `time_limit_s`. A child that dies, exceeds the
/// limit or is in one call for half of it has failed; an environment without the means (no GL)
/// skips. What the check finds out of the method and others need goes into the subject.
[[nodiscard]] CheckReport run_check(const Check& check, const Subject& subject,
                                    double time_limit_s);

/// The check of that name. Throws InputError that lists the names.
[[nodiscard]] const Check& find_check(const std::string& name);

}  // namespace lodbench::conformance
