#include "common/tile_streamer.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/error.h"

namespace lodbench::common {

namespace {

// Tiles that are read and wait to be uploaded: 1 MB of heights.
constexpr std::size_t kMostReady = 64;

}  // namespace

TileStreamer::TileStreamer(const Terrain& terrain, const TileStreamerOptions& options)
    : terrain_(terrain), pyramid_(terrain.tiles()), options_(options), pool_(options.slots) {}

void TileStreamer::upload(gl::Device& device, std::string_view label) {
    heights_ = gl::Texture(device, label, GL_TEXTURE_2D_ARRAY, GL_R32F, kTileSamples, kTileSamples,
                           1, options_.slots);
    LoadedTile root{pyramid_.root(), std::vector<float>(kTileSampleCount)};
    terrain_.read_tile(root.tile, root.heights);
    write(root, time_of_leaves());
    pool_.pin(*slot(root.tile));
    loader_.emplace(terrain_, options_.loader_threads, kMostReady);
}

void TileStreamer::release() {
    loader_.reset();
    heights_ = {};
}

std::vector<TileId> TileStreamer::touch(std::span<const TileId> tiles, std::uint64_t time) {
    std::vector<TileId> missing;
    for (const TileId& tile : tiles) {
        if (const auto place = slot(tile)) {
            pool_.touch(*place, time);
        } else {
            missing.push_back(tile);
        }
    }
    return missing;
}

bool TileStreamer::write(const LoadedTile& loaded, std::uint64_t time) {
    const std::optional<int> place = pool_.place(pyramid_.index(loaded.tile), time);
    if (!place) {
        ++counts_.dropped;
        return false;
    }
    heights_.write(0, 0, 0, kTileSamples, kTileSamples, GL_RED, GL_FLOAT, loaded.heights.data(),
                   *place);
    ++counts_.uploaded;
    return true;
}

void TileStreamer::require_room(std::span<const TileId> leaves) const {
    const auto count = std::ssize(leaves) - std::ranges::count(leaves, pyramid_.root());
    if (count < slots()) return;
    throw ContractError(
        fmt::format("TileStreamer: {} leaves besides the root; a pool of {} slots has room for {}",
                    count, slots(), slots() - 1));
}

void TileStreamer::update(const TileWishes& wishes) {
    require_room(wishes.leaves);
    ++frame_;
    std::vector<TileId> leaves = touch(wishes.leaves, time_of_leaves());
    counts_.requested += wishes.leaves.size();
    counts_.hits += wishes.leaves.size() - leaves.size();
    std::vector<TileId> ancestors = touch(wishes.ancestors, time_of_others());
    // The root has its slot for good; an ancestor that would take a leaf's is not worth reading.
    const std::size_t room =
        std::size_t(slots()) - 1 - std::min(wishes.leaves.size(), std::size_t(slots()) - 1);
    const std::size_t kept = wishes.ancestors.size() - ancestors.size();
    ancestors.resize(std::min(ancestors.size(), room - std::min(room, kept)));
    std::vector<TileId> prefetch = touch(wishes.prefetch, time_of_others());
    // One that would find no slot would be read again in the next frame, and the next.
    const std::size_t others = kept + ancestors.size() + wishes.prefetch.size() - prefetch.size();
    prefetch.resize(std::min(prefetch.size(), room - std::min(room, others)));

    // Where a tile is in two lists the first one counts.
    enum class Wish { to_draw, to_stand_in, to_keep_ready };
    std::unordered_map<std::size_t, Wish> wanted;
    for (const TileId& tile : leaves) wanted.emplace(pyramid_.index(tile), Wish::to_draw);
    for (const TileId& tile : ancestors) wanted.emplace(pyramid_.index(tile), Wish::to_stand_in);
    for (const TileId& tile : prefetch) wanted.emplace(pyramid_.index(tile), Wish::to_keep_ready);
    for (const LoadedTile& loaded : loader_->take(std::size_t(options_.uploads_per_frame))) {
        const auto found = wanted.find(pyramid_.index(loaded.tile));
        if (found == wanted.end()) {
            // Nobody wants it any more: it has been read, and stays where nothing has to go for it
            // that a frame has used since it was asked for.
            write(loaded, time_of_others() - 1);
            continue;
        }
        const Wish wish = found->second;
        if (write(loaded, wish == Wish::to_draw ? time_of_leaves() : time_of_others()) &&
            wish == Wish::to_keep_ready) {
            ++counts_.prefetched;
        }
    }

    const auto there = [this](const TileId& tile) { return slot(tile).has_value(); };
    std::vector<TileId> missing = std::move(ancestors);
    missing.insert(missing.end(), leaves.begin(), leaves.end());
    std::erase_if(missing, there);
    std::ranges::stable_sort(missing, std::ranges::greater{}, &TileId::level);
    if (missing.empty()) {
        missing = std::move(prefetch);
        std::erase_if(missing, there);
    }
    loader_->request(missing);
}

void TileStreamer::load(std::span<const TileId> leaves) {
    require_room(leaves);
    loader_->resume();  // whoever waits needs them read
    ++frame_;
    std::vector<TileId> missing = touch(leaves, time_of_leaves());
    counts_.requested += leaves.size();
    counts_.hits += leaves.size() - missing.size();
    loader_->request(missing);
    std::size_t left = missing.size();
    while (left > 0) {
        loader_->wait();
        for (const LoadedTile& loaded : loader_->take(kMostReady)) {
            // One that was on its way for an earlier frame may come too.
            if (slot(loaded.tile)) continue;
            const bool wanted = std::ranges::find(missing, loaded.tile) != missing.end();
            if (write(loaded, wanted ? time_of_leaves() : time_of_others() - 1) && wanted) --left;
        }
    }
}

void TileStreamer::forget() {
    if (loader_) loader_->clear();
    pool_.clear();
}

}  // namespace lodbench::common
