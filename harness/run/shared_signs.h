#pragma once
// The page of signs that a process and its children map.

#include <memory>

#include "run/vital_signs.h"

namespace lodbench::run {

/// Signs in shared memory: of the file behind `descriptor`, or with -1 new ones, which forks of
/// this process share. Throws EnvironmentError.
[[nodiscard]] std::shared_ptr<VitalSigns> map_signs(int descriptor = -1);

/// Finds a call that does not come back, asked now and then from outside.
class HangWatch {
public:
    /// `limit_s`: how long a call may take.
    HangWatch(std::shared_ptr<const VitalSigns> signs, double limit_s);
    /// The call that has been going on for longer than the limit; Call::none while there is none.
    [[nodiscard]] Call hung_in();

private:
    std::shared_ptr<const VitalSigns> signs_;
    double limit_s_;
    std::uint64_t beats_ = 0;
    double since_s_ = 0;  ///< the last beat that was seen
};

}  // namespace lodbench::run
