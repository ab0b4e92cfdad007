#include "stitching_strips/strip_builder.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>

#include "stitching_strips/tess_coordinates.h"

namespace lodbench::stitching_strips {
namespace {

/// Cells of a stretch that is not divided further where it is not all in view.
constexpr double kShortestStretch = 64;
/// Adjacent stretches are joined up to so many triangles: a thread's share.
constexpr std::size_t kMostJoined = 2048;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

std::size_t segments_before(std::span<const double> side, double place) {
    std::size_t low = 0, high = side.empty() ? 0 : side.size() - 1;
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (side[middle] + side[middle + 1] < 2 * place) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

StripBuilder::StripBuilder(const BlockTree& tree, int threads) : tree_(tree) {
    const int processors = tbb::this_task_arena::max_concurrency();
    if (threads > 0 && threads < processors) arena_ = std::make_unique<tbb::task_arena>(threads);
}

template <typename Work>
void StripBuilder::in_parallel(const Work& work) {
    if (arena_) {
        arena_->execute(work);
    } else {
        work();
    }
}

void StripBuilder::build(const BlockCut& cut, const std::optional<common::ViewFrustum>& frustum) {
    cut_ = &cut;
    frustum_ = &frustum;
    const double begin = seconds_now();
    list_edges();
    strips_.clear();
    patches_.clear();
    list_strips(kRoot);
    const double listed = seconds_now();
    in_parallel([this] { place_vertices(); });
    const double placed = seconds_now();
    in_parallel([this] {
        cut_stretches();
        triangulate();
    });
    add_patches();
    seconds_ = {listed - begin, placed - listed, seconds_now() - placed};
}

/// Which leaves are along which side of which strip, by the strips that the leaves know: sorted by
/// counting.
void StripBuilder::list_edges() {
    const std::size_t sides = 8 * cut_->splits().size();
    edge_begin_.assign(sides + 1, 0);
    const auto side_of = [&](const Leaf& leaf, int edge) {
        const int strip = leaf.neighbours[std::size_t(edge)];
        const auto split = std::size_t(cut_->split(parent(strip)));
        const Side side = edge == kSouth || edge == kEast ? kLeft : kRight;
        return 8 * split + 2 * std::size_t(strip % 4) + side;
    };
    const auto for_each_edge = [&](const auto& work) {
        for (const Leaf& leaf : cut_->leaves()) {
            for (int edge = 0; edge < 4; ++edge) {
                if (leaf.neighbours[std::size_t(edge)] != kNoStrip) {
                    work(std::uint32_t(&leaf - cut_->leaves().data()), side_of(leaf, edge));
                }
            }
        }
    };
    for_each_edge([&](std::uint32_t, std::size_t side) { ++edge_begin_[side + 1]; });
    for (std::size_t side = 0; side < sides; ++side) edge_begin_[side + 1] += edge_begin_[side];
    edge_leaves_.resize(edge_begin_.back());
    std::vector<std::uint32_t> next(edge_begin_.begin(), edge_begin_.end() - 1);
    for_each_edge([&](std::uint32_t leaf, std::size_t side) { edge_leaves_[next[side]++] = leaf; });
    // Anti-clockwise along a northern edge is westward: those are the right sides of eastward
    // strips.
    for (std::size_t side = 0; side < sides; ++side) {
        const bool eastward = side / 2 % 2 == 1;
        if (!eastward || side % 2 != kRight) continue;
        std::reverse(edge_leaves_.begin() + std::ptrdiff_t(edge_begin_[side]),
                     edge_leaves_.begin() + std::ptrdiff_t(edge_begin_[side + 1]));
    }
}

std::span<const std::uint32_t> StripBuilder::edges(int strip, Side side) const {
    const std::size_t place =
        8 * std::size_t(cut_->split(parent(strip))) + 2 * std::size_t(strip % 4) + side;
    return std::span(edge_leaves_)
        .subspan(edge_begin_[place], edge_begin_[place + 1] - edge_begin_[place]);
}

bool StripBuilder::may_see(glm::ivec2 south_west, glm::ivec2 north_east) const {
    if (!*frustum_) return true;
    return tree_.on_ground(south_west) && (*frustum_)->may_see(tree_.box(south_west, north_east));
}

StripBuilder::Strip StripBuilder::strip_between(int block, int number) const {
    const Square square = tree_.block(block).square;
    const int depth = tree_.block(block).depth;
    const int child = tree_.layout().side(depth + 1), gap = tree_.layout().gap(depth);
    Strip strip;
    strip.number = first_child(block) + number;
    strip.northward = number % 2 == 0;
    // From the south-west corner of the block: south, east, north, west.
    constexpr int kAhead[4][2] = {{1, 0}, {2, 1}, {1, 2}, {0, 1}};
    const auto offset = [&](int steps) {
        return steps == 0 ? 0 : steps == 1 ? child : child + gap;
    };
    strip.south_west =
        square.corner + glm::ivec2(offset(kAhead[number][0]), offset(kAhead[number][1]));
    strip.north_east =
        strip.south_west + (strip.northward ? glm::ivec2(gap, child) : glm::ivec2(child, gap));
    return strip;
}

void StripBuilder::list_strips(int block) {
    if (!cut_->is_split(block)) return;
    if (*frustum_ &&
        (!tree_.block(block).on_ground || !(*frustum_)->may_see(tree_.block(block).box)))
        return;
    for (int number = 0; number < 4; ++number) {
        const Strip strip = strip_between(block, number);
        if (may_see(strip.south_west, strip.north_east)) strips_.push_back(strip);
    }
    const Strip south = strip_between(block, 0);
    const glm::ivec2 centre(south.south_west.x, south.north_east.y);
    if (may_see(centre, centre + tree_.layout().gap(tree_.block(block).depth))) {
        patches_.push_back(block);
    }
    for (int child = 0; child < 4; ++child) list_strips(first_child(block) + child);
}

void StripBuilder::place_vertices() {
    const auto count = [&](std::span<const std::uint32_t> leaves) {
        std::size_t vertices = 0;
        for (const std::uint32_t leaf : leaves) {
            vertices += std::size_t(tess_segments(cut_->leaves()[leaf].factor)) + 1;
        }
        return vertices;
    };
    std::size_t total = 0;
    for (Strip& strip : strips_) {
        strip.first_vertex = total;
        strip.middle_vertex = strip.first_vertex + count(edges(strip.number, kLeft));
        strip.end_vertex = total = strip.middle_vertex + count(edges(strip.number, kRight));
    }
    vertices_.resize(total);
    along_.resize(total);
    tbb::parallel_for(std::size_t(0), strips_.size(), [&](std::size_t i) {
        place_side(strips_[i], kLeft, strips_[i].first_vertex);
        place_side(strips_[i], kRight, strips_[i].middle_vertex);
    });
}

void StripBuilder::place_side(const Strip& strip, Side side, std::size_t first) {
    const Edge edge =
        strip.northward ? (side == kLeft ? kEast : kWest) : (side == kLeft ? kSouth : kNorth);
    for (const std::uint32_t number : edges(strip.number, side)) {
        const Leaf& leaf = cut_->leaves()[number];
        const Square& square = tree_.block(leaf.block).square;
        const int corner = strip.northward ? square.corner.y : square.corner.x;
        const int segments = tess_segments(leaf.factor);
        for (int i = 0; i <= segments; ++i, ++first) {
            vertices_[first] = {number, vertex_place(edge, i)};
            along_[first] =
                double(corner) + double(square.side) * double(tess_coordinate(i, leaf.factor));
        }
    }
}

void StripBuilder::cut_stretches() {
    stretches_by_strip_.resize(strips_.size());
    tbb::parallel_for(std::size_t(0), strips_.size(), [&](std::size_t i) {
        stretches_by_strip_[i].clear();
        const Strip& strip = strips_[i];
        const double begin = along_[strip.first_vertex];
        // Behind every middle.
        cut_stretch(strip, begin, along_[strip.middle_vertex - 1] + 1, stretches_by_strip_[i]);
    });
    stretches_.clear();
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < strips_.size(); ++i) {
        for (const Stretch& stretch : stretches_by_strip_[i]) {
            stretches_.push_back({i, triangles, stretch});
            triangles += stretch.triangle_count();
        }
    }
    strip_triangles_ = triangles;
}

/// Of the segments with their middle in [begin, end), what may be seen: by both sides together,
/// since one side alone has no triangles.
void StripBuilder::cut_stretch(const Strip& strip, double begin, double end,
                               std::vector<Stretch>& stretches) const {
    const auto left = along(strip.first_vertex, strip.middle_vertex);
    const auto right = along(strip.middle_vertex, strip.end_vertex);
    const Stretch found = stretch_between(left, right, begin, end);
    if (found.triangle_count() == 0) return;
    if (*frustum_) {
        const int first =
            int(std::floor(std::min(left[found.left_begin], right[found.right_begin])));
        const int last = int(std::ceil(std::max(left[found.left_end], right[found.right_end])));
        glm::ivec2 south_west = strip.south_west, north_east = strip.north_east;
        (strip.northward ? south_west.y : south_west.x) = first;
        (strip.northward ? north_east.y : north_east.x) = last;
        if (!may_see(south_west, north_east)) return;
    }
    if (end - begin > kShortestStretch) {
        const double middle = std::floor((begin + end) / 2);
        cut_stretch(strip, begin, middle, stretches);
        cut_stretch(strip, middle, end, stretches);
        return;
    }
    if (!stretches.empty()) {
        Stretch& before = stretches.back();
        const bool adjacent =
            before.left_end == found.left_begin && before.right_end == found.right_begin;
        if (adjacent && before.triangle_count() + found.triangle_count() <= kMostJoined) {
            before.left_end = found.left_end;
            before.right_end = found.right_end;
            return;
        }
    }
    stretches.push_back(found);
}

void StripBuilder::triangulate() {
    indices_.resize(3 * (strip_triangles_ + 2 * patches_.size()));
    tbb::parallel_for(std::size_t(0), stretches_.size(), [&](std::size_t i) {
        const Part& part = stretches_[i];
        const Strip& strip = strips_[part.strip];
        const auto first_left = std::uint32_t(strip.first_vertex);
        const auto first_right = std::uint32_t(strip.middle_vertex);
        std::uint32_t* to = indices_.data() + 3 * part.first_triangle;
        stitch(along(strip.first_vertex, strip.middle_vertex),
               along(strip.middle_vertex, strip.end_vertex), part.stretch,
               [&](std::size_t l, std::size_t r, int side) {
                   const auto left = first_left + std::uint32_t(l);
                   const auto right = first_right + std::uint32_t(r);
                   *to++ = left;
                   *to++ = right;
                   *to++ = side == 0 ? left + 1 : right + 1;
               });
    });
}

/// The leaf at a corner of a block, counted as children are.
std::uint32_t StripBuilder::corner_leaf(int block, int corner) const {
    while (cut_->is_split(block)) block = first_child(block) + corner;
    return std::uint32_t(cut_->leaf(block));
}

void StripBuilder::add_patches() {
    std::size_t index = 3 * strip_triangles_;
    for (const int block : patches_) {
        const auto first = std::uint32_t(vertices_.size());
        for (int child = 0; child < 4; ++child) {
            // The corner of the south-western child that looks at the P-block is its north-eastern.
            const int facing = (child + 2) % 4;
            const std::uint32_t leaf = corner_leaf(first_child(block) + child, facing);
            const int segments = tess_segments(cut_->leaves()[leaf].factor);
            const Edge edge = facing < 2 ? kSouth : kNorth;
            const bool eastern = facing == 1 || facing == 2;
            vertices_.push_back({leaf, vertex_place(edge, eastern ? segments : 0)});
        }
        for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
            indices_[index++] = first + corner;
        }
    }
}

}  // namespace lodbench::stitching_strips
