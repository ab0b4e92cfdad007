#include "results/alike.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace lodbench::results {

namespace {

/// A text as words and numbers by turns: words first, and one more of them than numbers.
struct Parts {
    std::vector<std::string> words{""};
    std::vector<std::string> least, greatest;
};

Parts parts_of(const std::string& text) {
    const auto is_digit = [&text](std::size_t i) {
        return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    };
    Parts parts;
    for (std::size_t i = 0; i < text.size();) {
        if (!is_digit(i)) {
            parts.words.back() += text[i++];
            continue;
        }
        const std::size_t begin = i;
        while (is_digit(i) || (i < text.size() && text[i] == '.' && is_digit(i + 1))) ++i;
        parts.least.push_back(text.substr(begin, i - begin));
        parts.words.emplace_back();
    }
    parts.greatest = parts.least;
    return parts;
}

bool is_less(const std::string& a, const std::string& b) {
    return std::strtod(a.c_str(), nullptr) < std::strtod(b.c_str(), nullptr);
}

std::string text_of(const Parts& parts) {
    std::string text = parts.words.front();
    for (std::size_t i = 0; i < parts.least.size(); ++i) {
        text += parts.least[i];
        if (is_less(parts.least[i], parts.greatest[i])) text += " to " + parts.greatest[i];
        text += parts.words[i + 1];
    }
    return text;
}

}  // namespace

std::vector<std::string> fold_alike(const std::vector<std::string>& texts) {
    std::vector<Parts> kinds;
    for (const std::string& text : texts) {
        const Parts parts = parts_of(text);
        const auto known = std::ranges::find(kinds, parts.words, &Parts::words);
        if (known == kinds.end()) {
            kinds.push_back(parts);
            continue;
        }
        for (std::size_t i = 0; i < parts.least.size(); ++i) {
            known->least[i] = std::min(known->least[i], parts.least[i], is_less);
            known->greatest[i] = std::max(known->greatest[i], parts.greatest[i], is_less);
        }
    }
    std::vector<std::string> folded;
    for (const Parts& parts : kinds) folded.push_back(text_of(parts));
    return folded;
}

}  // namespace lodbench::results
