#pragma once
// Reads the tables of a history, whatever they hold.

#include "trend/database.h"

namespace lodbench::trend {

/// Within a transaction, of tables that this version knows by their number. Throws InputError for
/// what contradicts itself.
[[nodiscard]] History read_history(const Connection& connection);

}  // namespace lodbench::trend
