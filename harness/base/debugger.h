#pragma once
// A process that a debugger is to be attached to.

namespace lodbench::base {

/// Waits until a debugger is attached to this process, which any process of the same user may do.
/// Throws EnvironmentError where /proc does not tell.
void await_debugger();

}  // namespace lodbench::base
