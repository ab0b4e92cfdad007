#pragma once
// Ctrl-C and its like: heard once, so that the program can end in good order; the second ends it.

namespace lodbench::base {

/// From now on the first SIGINT or SIGTERM is noted, and has no other effect; the next ends the
/// process as it does by default. A signal that is ignored stays ignored.
void heed_interrupts();

/// Whether one was noted.
[[nodiscard]] bool interrupted();

}  // namespace lodbench::base
