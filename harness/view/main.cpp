// lodbench-view: the window of `lodbench view`, and with --session the process that holds a method
// for it.

#include <charconv>
#include <exception>
#include <span>
#include <string_view>

#include "base/console.h"
#include "cli/program.h"
#include "run/exit_status.h"
#include "view/command.h"
#include "window/session_child.h"

namespace {

/// Started by the window: --session and three descriptors.
int serve(std::span<char*> descriptors) {
    int numbers[3] = {-1, -1, -1};
    for (std::size_t i = 0; i < 3 && i < descriptors.size(); ++i) {
        const std::string_view text = descriptors[i];
        std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
    }
    try {
        return lodbench::window::serve_session(numbers[0], numbers[1], numbers[2]);
    } catch (const std::exception& error) {
        lodbench::base::tell("lodbench-view --session: {}", error.what());
        return lodbench::run::kNothingMeasured;
    }
}

}  // namespace

int main(int argc, char** argv) {
    lodbench::base::secure_standard_streams();
    if (argc == 5 && std::string_view(argv[1]) == "--session") {
        return serve(std::span(argv + 2, 3));
    }
    CLI::App app{"Fly and look: methods side by side over a scenario's terrain, and their errors.",
                 "lodbench view"};
    int status = 0;
    lodbench::view::add_view_options(app, status);
    return lodbench::cli::run_program(app, argc, argv, status);
}
