// lodbench: dispatches to one file per command.

#include "base/console.h"
#include "cli/commands.h"
#include "cli/program.h"

int main(int argc, char** argv) {
    lodbench::base::secure_standard_streams();
    CLI::App app{
        "lodbench measures terrain level-of-detail methods: each is a plugin, flown over the same "
        "terrain on the same path and measured from outside.",
        "lodbench"};
    app.require_subcommand(1);
    int status = 0;
    using namespace lodbench::cli;
    for (const auto add :
         {add_list,      add_describe,   add_run,     add_sweep, add_match,   add_economy,
          add_reproduce, add_extremes,   add_plan,    add_merge, add_compare, add_baseline,
          add_report,    add_trend,      add_cell,    add_mesh,  add_frames,  add_view,
          add_terrain,   add_new_method, add_validate}) {
        add(app, status);
    }
    return run_program(app, argc, argv, status);
}
