#include "cli/commands.h"

namespace lodbench::cli {

void add_list(CLI::App&, int&) {}

}  // namespace lodbench::cli
