#pragma once
// The command line of the window.

namespace CLI {
class App;
}

namespace lodbench::view {

/// Makes `app` the window: its callback opens it and sets `status`.
void add_view_options(CLI::App& app, int& status);

}  // namespace lodbench::view
