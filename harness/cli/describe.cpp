#include "cli/commands.h"

namespace lodbench::cli {

void add_describe(CLI::App&, int&) {}

}  // namespace lodbench::cli
