#include "cli/commands.h"

namespace lodbench::cli {

void add_new_method(CLI::App&, int&) {}

}  // namespace lodbench::cli
