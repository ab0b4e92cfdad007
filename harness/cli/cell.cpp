#include "cli/commands.h"

namespace lodbench::cli {

void add_cell(CLI::App&, int&) {}

}  // namespace lodbench::cli
