#include "run/settings.h"

#include <fmt/format.h>

#include "api/error.h"

namespace lodbench::run {

Setting parse_setting(std::string_view text, std::string_view form) {
    const std::size_t equals = text.find('=');
    const std::size_t dot = text.substr(0, equals).find('.');
    Setting setting;
    if (equals != text.npos) {
        const std::size_t begin = dot == text.npos ? 0 : dot + 1;
        setting = {std::string(text.substr(0, dot == text.npos ? 0 : dot)),
                   std::string(text.substr(begin, equals - begin)),
                   std::string(text.substr(equals + 1))};
    }
    if (setting.name.empty() || setting.value.empty() || dot == 0) {
        throw InputError(fmt::format("--set {}: expected {}", text, form));
    }
    return setting;
}

}  // namespace lodbench::run
