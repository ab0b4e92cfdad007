#include "cli/commands.h"

namespace lodbench::cli {

void add_validate(CLI::App&, int&) {}

}  // namespace lodbench::cli
