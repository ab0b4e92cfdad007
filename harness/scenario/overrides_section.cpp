#include "scenario/overrides_section.h"

#include <sstream>
#include <string>

namespace lodbench::scenario {

std::string toml_text(const toml::node& node) {
    toml::array list;
    node.visit([&](const auto& value) { list.push_back(value); });
    if (toml::table* table = list[0].as_table()) table->is_inline(true);
    std::ostringstream stream;
    stream << list;
    const std::string text = stream.str();
    // Without the brackets of `list` and the blanks and line breaks within them.
    const std::size_t begin = text.find_first_not_of(" \n", text.find('[') + 1);
    const std::size_t end = text.find_last_not_of(" \n", text.rfind(']') - 1);
    return text.substr(begin, end + 1 - begin);
}

Overrides read_overrides(Section& section, std::string_view key) {
    Overrides overrides;
    const auto table = section.section(key);
    if (!table) return overrides;
    for (const auto& [name, node] : table->table()) {
        overrides.set(std::string(name.str()), toml_text(node), table->where(name.str()));
    }
    return overrides;
}

Overrides merged(Overrides base, const Overrides& over) {
    for (const auto& [key, value] : over.values()) base.set(key, value.toml, value.where);
    return base;
}

}  // namespace lodbench::scenario
