#pragma once
// The process that holds a method for the window: the same stage, terrain and measuring as a cell.

namespace lodbench::window {

/// Answers what comes through `socket` (see messages.h) until the other side closes it. Maps the
/// memory for pictures behind `picture` and the signs of life behind `signs`. Exit status; a method
/// that failed ends the process after its last answer.
[[nodiscard]] int serve_session(int socket, int signs, int picture);

}  // namespace lodbench::window
