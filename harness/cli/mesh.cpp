#include "cli/commands.h"

namespace lodbench::cli {

void add_mesh(CLI::App&, int&) {}

}  // namespace lodbench::cli
