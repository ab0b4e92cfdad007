#include "run/view_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "api/error.h"
#include "base/files.h"
#include "base/hash.h"

namespace lodbench::run {

namespace fs = std::filesystem;

namespace {

/// Of the disk, for the results.
constexpr std::uint64_t kLeftBytes = std::uint64_t{256} << 20U;

/// Goes up when the layout below does, or what makes a view.
constexpr std::uint64_t kLayout = 1;

// A file is a header, the three parts one after another, and the hash of all before it, in the
// words of this machine. Of the bits of samples only the runs of words that are not zero are kept,
// each behind its place and length: a camera sees few of a terrain's samples, and those close
// together.
struct Header {
    std::uint64_t key, seen_words, seen_kept, hits, picture;
};

std::vector<std::uint64_t> packed(const std::vector<std::uint64_t>& words) {
    std::vector<std::uint64_t> result;
    for (std::size_t i = 0; i < words.size();) {
        if (words[i] == 0) {
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < words.size() && words[end] != 0) ++end;
        result.push_back(i);
        result.push_back(end - i);
        result.insert(result.end(), words.begin() + std::ptrdiff_t(i),
                      words.begin() + std::ptrdiff_t(end));
        i = end;
    }
    return result;
}

std::optional<std::vector<std::uint64_t>> unpacked(std::span<const std::uint64_t> kept,
                                                   std::size_t count) {
    std::vector<std::uint64_t> words(count);
    while (!kept.empty()) {
        if (kept.size() < 2) return std::nullopt;
        const std::uint64_t place = kept[0];
        const std::uint64_t length = kept[1];
        kept = kept.subspan(2);
        if (length > kept.size() || place > count || length > count - place) return std::nullopt;
        std::ranges::copy(kept.first(length), words.begin() + std::ptrdiff_t(place));
        kept = kept.subspan(length);
    }
    return words;
}

template <typename Value>
std::string_view bytes_of(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

/// Nothing where the text ends before.
template <typename Value>
std::optional<std::vector<Value>> take(std::string_view& text, std::uint64_t count) {
    if (count > text.size() / sizeof(Value)) return std::nullopt;
    std::vector<Value> values(count);
    if (count > 0) std::memcpy(values.data(), text.data(), count * sizeof(Value));
    text.remove_prefix(count * sizeof(Value));
    return values;
}

std::uint64_t hash_of(std::string_view text) {
    base::WordHash hash;
    hash.add(std::as_bytes(std::span(text)));
    return hash.value();
}

std::string encoded(std::uint64_t key, const measure::ReferenceView& view) {
    const std::vector<std::uint64_t> seen = packed(view.seen);
    const Header header{key, view.seen.size(), seen.size(), view.hits.size(), view.picture.size()};
    std::string text;
    text.reserve(sizeof header + bytes_of(seen).size() + bytes_of(view.hits).size() +
                 view.picture.size() + sizeof(std::uint64_t));
    text.append(reinterpret_cast<const char*>(&header), sizeof header);
    text += bytes_of(seen);
    text += bytes_of(view.hits);
    text += bytes_of(view.picture);
    const std::uint64_t hash = hash_of(text);
    text.append(reinterpret_cast<const char*>(&hash), sizeof hash);
    return text;
}

std::optional<measure::ReferenceView> decoded(std::string_view text, std::uint64_t key) {
    Header header;
    std::uint64_t hash = 0;
    if (text.size() < sizeof header + sizeof hash) return std::nullopt;
    std::memcpy(&hash, text.data() + text.size() - sizeof hash, sizeof hash);
    text.remove_suffix(sizeof hash);
    if (hash_of(text) != hash) return std::nullopt;
    std::memcpy(&header, text.data(), sizeof header);
    text.remove_prefix(sizeof header);
    if (header.key != key) return std::nullopt;
    const auto kept = take<std::uint64_t>(text, header.seen_kept);
    auto hits = take<measure::ReferenceHit>(text, header.hits);
    auto picture = take<std::uint8_t>(text, header.picture);
    if (!kept || !hits || !picture) return std::nullopt;
    auto seen = unpacked(*kept, header.seen_words);
    if (!seen) return std::nullopt;
    return measure::ReferenceView{std::move(*seen), std::move(*hits), std::move(*picture)};
}

std::uint64_t size_of_files(const fs::path& folder) {
    std::uint64_t bytes = 0;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code ignored;
        const std::uintmax_t size = entry->file_size(ignored);
        if (!ignored) bytes += size;
    }
    return bytes;
}

}  // namespace

ViewCache::ViewCache(fs::path folder, std::string scenario, const std::string& terrain,
                     const std::string& device)
    : folder_(std::move(folder)), scenario_(std::move(scenario)) {
    base::WordHash hash;
    hash.add(kLayout);
    for (const std::string& text : {terrain, device}) {
        hash.add(text.size());
        hash.add(hash_of(text));
    }
    base_ = hash.value();
}

std::uint64_t ViewCache::key_of(const Camera& camera) const {
    base::WordHash hash;
    hash.add(base_);
    const glm::dquat& q = camera.orientation;
    for (const double value : {camera.position.x, camera.position.y, camera.position.z, q.w, q.x,
                               q.y, q.z, camera.vertical_fov, camera.near_plane}) {
        hash.add(std::bit_cast<std::uint64_t>(value));
    }
    hash.add(std::uint64_t(camera.viewport.width));
    hash.add(std::uint64_t(camera.viewport.height));
    return hash.value();
}

fs::path ViewCache::file_of(int frame) const {
    return folder_ / fmt::format("{}__{}.view", scenario_, frame);
}

std::optional<measure::ReferenceView> ViewCache::find(int frame, const Camera& camera) const {
    if (!keeps()) return std::nullopt;
    const fs::path file = file_of(frame);
    std::error_code ignored;
    if (fs::symlink_status(file, ignored).type() != fs::file_type::regular ||
        fs::file_size(file, ignored) > kMostBytes) {
        return std::nullopt;
    }
    try {
        return decoded(base::read_text(file), key_of(camera));
    } catch (const EnvironmentError&) {  // not readable: as good as not there
        return std::nullopt;
    }
}

void ViewCache::keep(int frame, const Camera& camera, const measure::ReferenceView& view) {
    std::error_code ignored;
    if (fs::symlink_status(folder_, ignored).type() != fs::file_type::directory) return;
    const std::string text = encoded(key_of(camera), view);
    const fs::space_info disk = fs::space(folder_, ignored);
    if (ignored || disk.available < text.size() + kLeftBytes) return;
    // Cells fly one after the other: nobody else writes there meanwhile.
    if (!bytes_) bytes_ = size_of_files(folder_);
    if (*bytes_ + text.size() > kMostBytes) return;
    try {
        base::write_whole(file_of(frame), text, base::Keep::for_now);
        *bytes_ += text.size();
    } catch (const EnvironmentError&) {  // a convenience: the disk is the results'
    }
}

}  // namespace lodbench::run
