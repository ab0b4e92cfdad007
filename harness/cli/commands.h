#pragma once
// One function a command, one file a function. Each adds its subcommand; the callback sets `status`
// to the exit status (0 when it does nothing) and throws InputError or EnvironmentError for what it
// cannot do.

namespace CLI {
class App;
}

namespace lodbench::cli {

void add_list(CLI::App& app, int& status);
void add_describe(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_sweep(CLI::App& app, int& status);
void add_match(CLI::App& app, int& status);
void add_economy(CLI::App& app, int& status);
void add_cell(CLI::App& app, int& status);  ///< hidden: the child process of `run`
void add_reproduce(CLI::App& app, int& status);
void add_extremes(CLI::App& app, int& status);
void add_plan(CLI::App& app, int& status);
void add_merge(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_baseline(CLI::App& app, int& status);
void add_report(CLI::App& app, int& status);
void add_trend(CLI::App& app, int& status);
void add_mesh(CLI::App& app, int& status);
void add_frames(CLI::App& app, int& status);
void add_view(CLI::App& app, int& status);
void add_terrain(CLI::App& app, int& status);
void add_new_method(CLI::App& app, int& status);
void add_validate(CLI::App& app, int& status);

}  // namespace lodbench::cli
