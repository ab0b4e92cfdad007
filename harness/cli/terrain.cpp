#include "cli/commands.h"

namespace lodbench::cli {

void add_terrain(CLI::App&, int&) {}

}  // namespace lodbench::cli
