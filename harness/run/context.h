#pragma once
// A result without its context is no result: what run.json says of tool and machine.

#include <json/value.h>

#include "run/cell.h"

namespace lodbench::run {

/// Tool version, commit, build type, compiler, operating system, processor, cores.
[[nodiscard]] Json::Value machine_context();

/// What a cell's child saw of its GL context.
[[nodiscard]] Json::Value gl_context(const CellResult& result);

}  // namespace lodbench::run
