#pragma once
// Standard input, output and error as the program needs them, whatever it was started with.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "base/printable.h"

namespace lodbench::base {

/// Opens those of descriptors 0 to 2 that are closed on /dev/null, so that no file of ours takes
/// their numbers, and lets a write beyond the limit of file sizes, or into a pipe that nobody
/// reads, fail instead of end the process.
void secure_standard_streams();

/// Writes to standard error, as it is. What cannot be written is lost: progress that nobody can
/// read must not end a run.
void write_error(std::string_view text) noexcept;

/// A line on standard error; characters that would steer a terminal are escaped (`plain`).
template <typename... Values>
void tell(fmt::format_string<Values...> form, Values&&... values) {
    write_error(plain(fmt::format(form, std::forward<Values>(values)...)) + "\n");
}

/// Writes to standard output; characters that would steer a terminal are escaped (`plain`). What
/// cannot be written is told by `standard_output_error`.
void write_output(std::string_view text);

template <typename... Values>
void print(fmt::format_string<Values...> form, Values&&... values) {
    write_output(fmt::format(form, std::forward<Values>(values)...));
}

/// Flushes standard output; "" or why what was printed did not arrive, in the system's words.
[[nodiscard]] std::string standard_output_error();

}  // namespace lodbench::base
