#include "measure/hidden_ground.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>

namespace lodbench::measure {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Far more than the roundings of a height over an edge, of a slope and of a coordinate in the
/// grid.
constexpr double kRounding = 1e-12;

/// The directions in plan that a camera's frustum holds, about the middle one.
struct PlanView {
    bool all = true;
    glm::dvec2 middle{1, 0};
    double left = 0, right = 0;  ///< radians from the middle, counter-clockwise

    /// `margin`: a tangent by which the frustum is widened on all sides.
    PlanView(const Camera& camera, double margin) {
        const glm::dvec2 tangents = camera.half_tangents() + margin;
        glm::dvec2 corners[4];
        for (int i = 0; i < 4; ++i) {
            corners[i] = glm::dvec2(camera.forward() +
                                    camera.right() * ((i & 1) != 0 ? tangents.x : -tangents.x) +
                                    camera.up() * ((i & 2) != 0 ? tangents.y : -tangents.y));
        }
        const glm::dvec2 sum = corners[0] + corners[1] + corners[2] + corners[3];
        if (!(glm::length(sum) > 0)) return;
        middle = glm::normalize(sum);
        for (const glm::dvec2& corner : corners) {
            // A frustum that holds the vertical looks every way.
            if (!(glm::dot(corner, middle) > 1e-3 * glm::length(corner))) return;
            left = std::max(left, angle(corner));
            right = std::min(right, angle(corner));
        }
        all = false;
    }

    [[nodiscard]] double angle(const glm::dvec2& direction) const {
        return std::atan2(middle.x * direction.y - middle.y * direction.x,
                          glm::dot(middle, direction));
    }
    /// Whether a sector may hold one of the directions; its ends less than half a turn apart.
    [[nodiscard]] bool holds(const glm::dvec2& one, const glm::dvec2& other) const {
        if (all) return true;
        const auto [low, high] = std::minmax({angle(one), angle(other)});
        // Behind the camera the ends lie on both sides of the jump of the angle.
        if (high - low > 3) return false;
        return low <= left && high >= right;
    }
};

/// Bit j of word i becomes bit i of word j: ever smaller squares change places across the diagonal
/// (Warren: Hacker's Delight, 2nd edition, 2012, section 7-3).
void transpose(std::array<std::uint64_t, 64>& words) {
    std::uint64_t low = 0x00000000FFFFFFFF;
    for (unsigned side = 32; side > 0; side /= 2, low ^= low << side) {
        for (unsigned i = 0; i < 64; i = (i + side + 1) & ~side) {
            const std::uint64_t change = (words[i] >> side ^ words[i + side]) & low;
            words[i] ^= change << side;
            words[i + side] ^= change;
        }
    }
}

}  // namespace

/// The lines of sight that cross the lines of samples `line` one after another, in the direction
/// `step`: columns to the east or the west, rows to the north or the south. `across` counts samples
/// along a line.
struct HiddenGround::Quadrant {
    std::span<const float> heights;
    bool columns = true;
    int step = 1;
    int lines = 0, acrosses = 0;
    std::size_t line_stride = 0, across_stride = 0;
    double eye_line = 0, eye_across = 0, eye_z = 0;
    glm::dvec2 along{0}, beside{0};    ///< metres in plan of a step along, of one across
    double shortest = 0, longest = 0;  ///< of the two, metres
    int first_line = 0;
    int eye_block_line = 0;   ///< the blocks beside the eye; outside the grid where it is
    double highest_rise = 0;  ///< metres from the eye to the farthest height, up or down
    double nearest = 0;       ///< cells from the eye to the first line that hides anything
    double tolerance = 0;     ///< metres
    double pixel = 0;         ///< the widest angle that a pixel is seen at
    int sectors = 0;

    [[nodiscard]] double slope_of_border(int border) const { return -1 + 2.0 * border / sectors; }
    [[nodiscard]] glm::dvec2 direction_of_border(int border) const {
        return along + slope_of_border(border) * beside;
    }
    [[nodiscard]] double distance(int line) const { return step * (line - eye_line); }
    [[nodiscard]] std::size_t index(int line, int across) const {
        return std::size_t(line) * line_stride + std::size_t(across) * across_stride;
    }
};

/// One run of sectors, over all lines of a quadrant.
class HiddenGround::Sweep {
public:
    Sweep(HiddenGround& hidden, const ReferenceTerrain& terrain, const Quadrant& quadrant,
          int first, int end, bool with_blocks)
        : hidden_(hidden),
          terrain_(terrain),
          q_(quadrant),
          first_(first),
          end_(end),
          with_blocks_(with_blocks),
          horizon_(std::size_t(end - first), -kInfinity),
          edge_(std::size_t(end - first) + 1),
          row_(std::size_t(end - first) + 1) {}

    void run() {
        int shown = q_.eye_block_line;
        if (with_blocks_) show_blocks(shown);
        for (int line = q_.first_line; line >= 0 && line < q_.lines; line += q_.step) {
            const double distance = q_.distance(line);
            // Of the cells behind the line.
            const int next = (q_.step > 0 ? line : line - 1) / kBlockCells;
            if (with_blocks_ && next != shown) show_blocks(shown = next);
            hide_samples(line, distance);
            // The rim of a sample's own cells hides nothing where it is the border of the extent.
            if (line > 0 && line + 1 < q_.lines && distance >= q_.nearest) raise(line, distance);
            if (line % kSquare == 0) terrain_.forget();
        }
    }

private:
    [[nodiscard]] double across_at(int border, double distance) const {
        return q_.eye_across + q_.slope_of_border(border) * distance;
    }

    void hide_samples(int line, double distance) {
        if (!(distance > 0)) return;
        const int from =
            int(std::clamp(std::floor(across_at(first_, distance)), 0.0, double(q_.acrosses)));
        const int to =
            int(std::clamp(std::ceil(across_at(end_, distance)), -1.0, double(q_.acrosses - 1)));
        const double half = q_.sectors / 2.0;
        const double inverse = 1 / distance;
        const double margin = q_.tolerance / q_.nearest;
        int word_index = from / 64;
        std::uint64_t word = 0;
        for (int across = from; across <= to; ++across) {
            if (across / 64 != word_index) {
                add(line, std::exchange(word_index, across / 64), std::exchange(word, 0));
            }
            const double offset = across - q_.eye_across;
            // A diagonal belongs to one quadrant alone: rows'.
            if (!(q_.columns ? std::abs(offset) < distance : std::abs(offset) <= distance))
                continue;
            const int sector = std::min(int((offset * inverse + 1) * half), q_.sectors - 1);
            if (sector < first_ || sector >= end_) continue;
            const double rise = (double(q_.heights[q_.index(line, across)]) - q_.eye_z) * inverse;
            const double horizon = horizon_[std::size_t(sector - first_)];
            if (rise + kRounding * std::abs(rise) <
                horizon - kRounding * std::abs(horizon) - margin) {
                word |= std::uint64_t{1} << unsigned(across % 64);
            }
        }
        add(line, word_index, word);
    }

    /// The first and the last word of a task's stretch may be another's as well.
    void add(int line, int index, std::uint64_t bits) {
        if (bits == 0) return;
        Lines& lines = q_.columns ? hidden_.by_columns_ : hidden_.by_rows_;
        std::atomic_ref<std::uint64_t>(
            lines.bits[std::size_t(line) * std::size_t(lines.words) + std::size_t(index)])
            .fetch_or(bits, std::memory_order_relaxed);
    }

    /// The edges of a line of samples, at each border between two sectors and at the samples
    /// between.
    void raise(int line, double distance) {
        const float* const samples = &q_.heights[q_.index(line, 0)];
        const std::size_t stride = q_.across_stride;
        const double step = 2.0 * distance / q_.sectors;
        const double begin = q_.eye_across - distance;
        const std::size_t count = horizon_.size();
        for (std::size_t i = 0; i <= count; ++i) {
            const double across = begin + step * double(first_ + int(i));
            if (!(across >= 0 && across < q_.acrosses - 1)) {
                edge_[i] = -kInfinity;
                row_[i] = 0;
                continue;
            }
            const int low = int(across);
            const double a = samples[std::size_t(low) * stride];
            const double b = samples[std::size_t(low + 1) * stride];
            edge_[i] = a + (across - low) * (b - a);
            row_[i] = low;
        }
        const double inverse = 1 / distance;
        for (std::size_t i = 0; i < count; ++i) {
            double least = std::min(edge_[i], edge_[i + 1]);
            if (least == -kInfinity) continue;
            for (int across = row_[i] + 1; across <= row_[i + 1]; ++across) {
                least = std::min(least, double(samples[std::size_t(across) * stride]));
            }
            horizon_[i] = std::max(horizon_[i], (least - q_.eye_z) * inverse);
        }
    }

    /// A line of blocks, before its own samples have raised the horizon: in sight where one of the
    /// sectors that they lie in, with a pixel to each side, lets the highest of them be seen.
    void show_blocks(int block_line) {
        if (block_line < 0 || block_line * kBlockCells >= q_.lines - 1) return;
        const double begin = q_.distance(block_line * kBlockCells);
        const double end = q_.distance(std::min((block_line + 1) * kBlockCells, q_.lines - 1));
        const double near_distance = std::min(begin, end);
        const double far_distance = std::max(begin, end);
        if (!(far_distance > 0)) return;
        const bool beside_eye = !(near_distance > q_.nearest);
        const double steepest = beside_eye ? 0 : q_.highest_rise / near_distance;
        const double reach = 1 + far_distance * aside(steepest);
        const auto block_at = [&](double across) {
            return int(
                std::clamp(across / kBlockCells, 0.0, double((q_.acrosses - 2) / kBlockCells)));
        };
        const double nearer = std::max(near_distance, 0.0);
        const int from =
            block_at(std::min(across_at(first_, far_distance), across_at(first_, nearer)) - reach);
        const int to =
            block_at(std::max(across_at(end_, far_distance), across_at(end_, nearer)) + reach);
        for (int block = from; block <= to; ++block) {
            if (beside_eye || !is_hidden(block_line, block, near_distance, far_distance)) {
                std::atomic_ref<std::uint8_t>(
                    hidden_.blocks_in_sight_[block_index(block_line, block)])
                    .store(1, std::memory_order_relaxed);
            }
        }
    }

    /// A pixel to the side of a line of sight that rises so many metres a cell, as a slope in the
    /// grid.
    [[nodiscard]] double aside(double rise) const {
        const double steepness = rise / q_.shortest;
        return q_.pixel * std::sqrt(1 + steepness * steepness) * 2 * q_.longest / q_.shortest;
    }

    [[nodiscard]] std::size_t block_index(int line, int across) const {
        const int row = q_.columns ? across : line;
        const int column = q_.columns ? line : across;
        return std::size_t(row) * std::size_t(hidden_.block_columns_) + std::size_t(column);
    }

    [[nodiscard]] bool is_hidden(int line, int across, double near_distance,
                                 double far_distance) const {
        const int row = (q_.columns ? across : line) * kBlockCells;
        const int column = (q_.columns ? line : across) * kBlockCells;
        const double low = across * kBlockCells - q_.eye_across;
        const double high = std::min((across + 1) * kBlockCells, q_.acrosses - 1) - q_.eye_across;
        const double rise_z =
            terrain_.range({row, column, kBlockCells + 1, kBlockCells + 1}).high - q_.eye_z;
        const double rise = rise_z / (rise_z > 0 ? near_distance : far_distance);
        const double slope_low = std::min(low / near_distance, low / far_distance);
        const double slope_high = std::max(high / near_distance, high / far_distance);
        const double wider = aside(std::abs(rise));
        const auto sector = [&](double slope) {
            return std::clamp((slope + 1) * (q_.sectors / 2.0), double(first_) - 1,
                              double(end_) + 1);
        };
        const int begin = std::max(first_, int(std::floor(sector(slope_low - wider))));
        const int end = std::min(end_, int(std::ceil(sector(slope_high + wider))) + 1);
        const double steepness = std::abs(rise) / q_.shortest;
        const double margin = q_.pixel * (1 + steepness * steepness) * 1.5 * q_.longest;
        for (int i = begin; i < end; ++i) {
            if (!(rise + margin < horizon_[std::size_t(i - first_)])) return false;
        }
        return true;
    }

    HiddenGround& hidden_;
    const ReferenceTerrain& terrain_;
    const Quadrant& q_;
    int first_, end_;  ///< sectors
    bool with_blocks_;
    std::vector<double> horizon_;  ///< metres a cell along
    std::vector<double> edge_;     ///< at the borders of the sectors, of one line
    std::vector<int> row_;
};

HiddenGround::Square HiddenGround::square(int row, int column) const {
    Square bits{};
    const int columns = int(by_columns_.bits.size() / std::size_t(by_columns_.words));
    const int end = std::min((column + 1) * kSquare, columns);
    for (int i = column * kSquare; i < end; ++i) {
        bits[std::size_t(i - column * kSquare)] = by_columns_.word(i, row);
    }
    transpose(bits);
    const int rows = int(by_rows_.bits.size() / std::size_t(by_rows_.words));
    const int last = std::min((row + 1) * kSquare, rows);
    for (int i = row * kSquare; i < last; ++i) {
        bits[std::size_t(i - row * kSquare)] |= by_rows_.word(i, column);
    }
    return bits;
}

bool HiddenGround::looks_from_above(const ReferenceTerrain& terrain, const Camera& camera) const {
    const glm::dvec2 tangents = camera.half_tangents();
    const double radius = 1.01 * camera.near_plane * std::sqrt(1 + glm::dot(tangents, tangents));
    const glm::dvec2 position(camera.position);
    const TerrainInfo& info = terrain.info();
    if (glm::clamp(position, info.extent_min(), info.extent_max()) != position) return false;
    return camera.position.z - radius > terrain.interval_within(position, 1.5 * radius).high;
}

HiddenGround::HiddenGround(const ReferenceTerrain& terrain, const Camera& camera)
    : block_columns_((terrain.info().columns - 2) / kBlockCells + 1),
      by_rows_(terrain.info().rows, terrain.info().columns),
      by_columns_(terrain.info().columns, terrain.info().rows) {
    const TerrainInfo& info = terrain.info();
    const std::size_t block_count =
        std::size_t(block_columns_) * std::size_t((info.rows - 2) / kBlockCells + 1);
    const bool with_blocks = looks_from_above(terrain, camera);
    blocks_in_sight_.resize(block_count, with_blocks ? 0 : 1);
    constexpr double kFarthest = 0x1p30;  // cells: beyond, coordinates in the grid are too rough
    const glm::dvec2 cells = (glm::dvec2(camera.position) - info.origin) / info.spacing;
    const glm::dvec2 eye(cells.x, info.rows - 1 - cells.y);
    if (!(std::abs(eye.x) < kFarthest && std::abs(eye.y) < kFarthest)) {
        std::ranges::fill(blocks_in_sight_, 1);
        return;
    }
    const glm::dvec2 tangents = camera.half_tangents();
    const double reach =
        camera.near_plane * std::sqrt(1 + glm::dot(tangents, tangents)) * (1 + 1e-9);
    const double pixel = 1 / camera.lambda();
    const PlanView view(camera, 2 * pixel);
    const HeightInterval whole = terrain.range({0, 0, info.rows, info.columns});
    // As many that one is a sample wide at the terrain's far end.
    const int sectors = 2 * int(std::bit_ceil(unsigned(std::max(info.rows, info.columns) - 1)));
    constexpr int kRun = 512;  // sectors a task
    struct Task {
        std::size_t quadrant;
        int first, end;
    };
    std::vector<Quadrant> quadrants;
    std::vector<Task> tasks;
    for (int i = 0; i < 4; ++i) {
        Quadrant q;
        q.heights = terrain.heights();
        q.columns = i < 2;
        q.step = i % 2 == 0 ? 1 : -1;
        q.lines = q.columns ? info.columns : info.rows;
        q.acrosses = q.columns ? info.rows : info.columns;
        q.line_stride = q.columns ? 1 : std::size_t(info.columns);
        q.across_stride = q.columns ? std::size_t(info.columns) : 1;
        q.eye_line = q.columns ? eye.x : eye.y;
        q.eye_across = q.columns ? eye.y : eye.x;
        q.eye_z = camera.position.z;
        // Rows are counted to the south.
        q.along = q.columns ? glm::dvec2(q.step * info.spacing.x, 0)
                            : glm::dvec2(0, -q.step * info.spacing.y);
        q.beside = q.columns ? glm::dvec2(0, -info.spacing.y) : glm::dvec2(info.spacing.x, 0);
        q.shortest = std::min(info.spacing.x, info.spacing.y);
        q.longest = std::max(info.spacing.x, info.spacing.y);
        q.highest_rise = std::max(std::abs(whole.low - q.eye_z), std::abs(whole.high - q.eye_z));
        const double first = q.step > 0 ? std::floor(q.eye_line) + 1 : std::ceil(q.eye_line) - 1;
        q.first_line = int(q.step > 0 ? std::max(first, 0.0) : std::min(first, q.lines - 1.0));
        if (q.first_line < 0 || q.first_line >= q.lines) continue;
        const double eye_cell = q.step > 0 ? std::floor(q.eye_line) : std::ceil(q.eye_line) - 1;
        q.eye_block_line = eye_cell < 0 || eye_cell >= q.lines ? -1 : int(eye_cell) / kBlockCells;
        q.nearest = std::max(reach / glm::length(q.along), 1e-3);
        const double farthest =
            std::abs(q.eye_across) + q.lines + q.acrosses + std::abs(q.eye_line);
        q.tolerance = kRounding * (farthest * (whole.high - whole.low) + std::abs(whole.low) +
                                   std::abs(whole.high) + 16 * std::abs(q.eye_z));
        q.pixel = pixel;
        q.sectors = sectors;
        int run = -1;
        for (int sector = 0; sector <= sectors; ++sector) {
            const bool in_view = sector < sectors && view.holds(q.direction_of_border(sector),
                                                                q.direction_of_border(sector + 1));
            if (run >= 0 && (!in_view || sector - run == kRun)) {
                tasks.push_back({quadrants.size(), run, sector});
                run = -1;
            }
            if (in_view && run < 0) run = sector;
        }
        quadrants.push_back(q);
    }
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
        const Task& task = tasks[i];
        Sweep(*this, terrain, quadrants[task.quadrant], task.first, task.end, with_blocks).run();
    });
}

}  // namespace lodbench::measure
