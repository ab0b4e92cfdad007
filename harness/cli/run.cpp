#include "cli/commands.h"

namespace lodbench::cli {

void add_run(CLI::App&, int&) {}

}  // namespace lodbench::cli
