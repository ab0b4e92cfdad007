#include "run/sensor_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "base/child_process.h"

namespace lodbench::run {

namespace fs = std::filesystem;

std::string text_in(const fs::path& file) {
    constexpr std::size_t kMost = 1 << 16;
    // Not to wait for whoever would write into what should be a sensor, and is a pipe.
    const base::FileDescriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    std::string text;
    char block[4096];
    for (ssize_t count = 0; opened && text.size() < kMost &&
                            (count = read(opened.number(), block, sizeof block)) > 0;) {
        text.append(block, std::size_t(count));
    }
    return text;
}

std::optional<std::string> line_in(const fs::path& file) {
    constexpr const char* kSpaces = " \t\r\n";
    const std::string text = text_in(file);
    const std::string line = text.substr(0, std::min<std::size_t>(text.find('\n'), 4096));
    const std::size_t begin = line.find_first_not_of(kSpaces);
    if (begin == line.npos) return std::nullopt;
    return line.substr(begin, line.find_last_not_of(kSpaces) + 1 - begin);
}

std::optional<double> number_in(const fs::path& file, double unit) {
    const std::optional<std::string> line = line_in(file);
    if (!line) return std::nullopt;
    double number = 0;
    const char* end = line->data() + line->size();
    const auto read = std::from_chars(line->data(), end, number, std::chars_format::fixed);
    // Infinity and NaN are numbers to from_chars, and of no sensor.
    constexpr double kMost = 1e18;
    if (read.ec != std::errc() || read.ptr != end || !(number >= 0 && number < kMost)) {
        return std::nullopt;
    }
    return number / unit;
}

std::optional<double> positive_in(const fs::path& file, double unit) {
    const std::optional<double> number = number_in(file, unit);
    return number && *number > 0 ? number : std::nullopt;
}

std::vector<fs::path> entries(const fs::path& folder, const std::string& prefix) {
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().filename().string().starts_with(prefix)) found.push_back(entry->path());
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace lodbench::run
