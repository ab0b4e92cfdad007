#pragma once
// The three classes of error that the project knows.

#include <stdexcept>
#include <string>

namespace lodbench {

/// A user's mistake: names file, line, value and remedy. The command ends with exit status 2.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An environment's refusal (no GPU, no disk, no memory): says what was tried.
struct EnvironmentError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What the method needs and this device does not have: the cell is skipped, not failed.
struct UnsupportedError : EnvironmentError {
    using EnvironmentError::EnvironmentError;
};

/// A terrain's file failed while it was read: names the file and the tile. Ends the cell that flew
/// over it, not the others.
struct TerrainError : EnvironmentError {
    using EnvironmentError::EnvironmentError;
};

/// A programmer's mistake, a plugin author's included: says what was expected.
struct ContractError : std::logic_error {
    using std::logic_error::logic_error;
};

}  // namespace lodbench
