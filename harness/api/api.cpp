// What of the interface is not in its headers.

#include <fmt/format.h>

#include "api/error.h"
#include "api/params.h"
#include "api/terrain.h"

namespace lodbench {

void Terrain::read(const SampleRect& rect, std::span<float> heights) const {
    if (rect.row < 0 || rect.column < 0 || rect.rows < 0 || rect.columns < 0 ||
        rect.rows > info_.rows - rect.row || rect.columns > info_.columns - rect.column) {
        throw ContractError(fmt::format(
            "Terrain::read: rows {}+{}, columns {}+{} leave the grid of {} rows x {} columns",
            rect.row, rect.rows, rect.column, rect.columns, info_.rows, info_.columns));
    }
    const std::size_t count = std::size_t(rect.rows) * std::size_t(rect.columns);
    if (heights.size() != count) {
        throw ContractError(fmt::format("Terrain::read: expected room for {} samples, found {}",
                                        count, heights.size()));
    }
    copy_samples(rect, heights);
    samples_served_ += count;
}

const ParamValue& Params::find(std::string_view name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) {
        throw ContractError(fmt::format("Params: no parameter named '{}' was declared", name));
    }
    return found->second;
}

namespace {
template <typename T>
const T& typed(const ParamValue& value, std::string_view name, const char* type) {
    if (const T* held = std::get_if<T>(&value)) return *held;
    throw ContractError(fmt::format("Params: parameter '{}' was not declared as {}", name, type));
}
}  // namespace

bool Params::boolean(std::string_view name) const {
    return typed<bool>(find(name), name, "boolean");
}
std::int64_t Params::integer(std::string_view name) const {
    return typed<std::int64_t>(find(name), name, "integer");
}
double Params::real(std::string_view name) const {
    return typed<double>(find(name), name, "real");
}
const std::string& Params::choice(std::string_view name) const {
    return typed<std::string>(find(name), name, "choice");
}

}  // namespace lodbench
