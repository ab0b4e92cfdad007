#include "terrain/tile_store_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "api/error.h"

namespace lodbench::terrain {
namespace {

const std::filesystem::path& checked_name(const std::filesystem::path& file) {
    require_store_name(file);
    return file;
}

TerrainInfo checked_grid(const TerrainInfo& info) {
    check_grid(info);
    return info;
}

StoreSampling sampling_of(std::optional<double> step) {
    if (!step) return {};
    if (!(*step >= kLeastStep && *step <= kGreatestStep)) {
        throw InputError(
            fmt::format("a step of {} m; it must be {} to {}", *step, kLeastStep, kGreatestStep));
    }
    return {StoreSamples::steps, *step, 0};
}

}  // namespace

void require_store_name(const std::filesystem::path& file) {
    if (is_store(file)) return;
    throw InputError(fmt::format("{}: tiled stores are written as .tiles; give a name that ends so",
                                 file.string()));
}

StoreWriter::StoreWriter(const TerrainInfo& info, std::optional<double> step,
                         std::filesystem::path file)
    : file_(checked_name(file)),
      header_{checked_grid(info), sampling_of(step), 0},
      layout_(info.rows, info.columns, header_.sampling),
      pending_(file_),
      summaries_(layout_.pyramid()),
      checksums_(layout_.pyramid().count()),
      cutter_(
          info.rows, info.columns,
          [this](const TileId& tile, std::span<const float> heights) { add_tile(tile, heights); }),
      row_(std::size_t(info.columns)) {
    static_cast<void>(encode_header(header_));  // the name, before all the work
    pending_.reserve(layout_.file_bytes());
    grid_checksum_.add(std::uint32_t(info.rows));
    grid_checksum_.add(std::uint32_t(info.columns));
}

void StoreWriter::push(std::span<const float> row) {
    if (row.size() != row_.size()) {
        throw ContractError(fmt::format("StoreWriter::push: a row of {} heights, expected {}",
                                        row.size(), row_.size()));
    }
    for (std::size_t column = 0; column < row.size(); ++column) {
        if (!std::isfinite(row[column])) {
            refuse_height(header_.info, row_number_, int(column), row[column]);
        }
        row_[column] = row[column] + 0.0F;  // -0 + 0 = +0
    }
    if (header_.sampling.type == StoreSamples::steps) round_to_steps(row_);
    for (const float height : row_) grid_checksum_.add(std::bit_cast<std::uint32_t>(height));
    cutter_.push(row_);
    ++row_number_;
}

void StoreWriter::round_to_steps(std::span<float> row) {
    StoreSampling& sampling = header_.sampling;
    double lowest = 0;
    double highest = 0;
    for (std::size_t column = 0; column < row.size(); ++column) {
        // Too many steps for this rounding are too many for the check below.
        const double steps = (double(row[column]) / sampling.step + kRounding) - kRounding;
        lowest = column == 0 ? steps : std::min(lowest, steps);
        highest = column == 0 ? steps : std::max(highest, steps);
        row[column] = float(sampling.step * steps);
    }
    if (-lowest > double(kMostSteps) || highest > double(kMostSteps)) {
        throw InputError(fmt::format(
            "terrain '{}': heights of {} to {} m in row {} are more than {} steps of {} m from 0, "
            "where float32 does not tell them apart; give a greater step",
            header_.info.name, sampling.step * lowest, sampling.step * highest, row_number_,
            kMostSteps, sampling.step));
    }
    const bool first = row_number_ == 0;
    sampling.lowest =
        first ? std::int64_t(lowest) : std::min(sampling.lowest, std::int64_t(lowest));
    highest_ = first ? std::int64_t(highest) : std::max(highest_, std::int64_t(highest));
    constexpr std::int64_t kMostApart = 65535;
    if (highest_ - sampling.lowest > kMostApart) {
        const double range = sampling.step * double(highest_ - sampling.lowest);
        throw InputError(fmt::format(
            "terrain '{}': the heights down to row {}, {} to {} m, are more than {} steps of {} m "
            "apart: these rows alone need a step of {:.3g}, the rest may need more",
            header_.info.name, row_number_, sampling.height(sampling.lowest),
            sampling.height(highest_), kMostApart, sampling.step,
            1.01 * range / double(kMostApart)));
    }
}

void StoreWriter::add_tile(const TileId& tile, std::span<const float> heights) {
    summaries_.add(tile, heights);
    std::array<std::byte, kTileSampleCount * 4> buffer;
    const std::span<std::byte> record = std::span(buffer).first(layout_.record_bytes());
    encode_tile(heights, header_.sampling, record);
    base::WordHash hash;
    hash.add(record);
    checksums_[layout_.pyramid().index(tile)] = hash.value();
    pending_.write_at(layout_.offset(tile), record);
}

TerrainInfo StoreWriter::finish() {
    cutter_.finish();
    const TileSummary& root = summaries_.at(layout_.pyramid().root());
    header_.info.min_height = root.min_height;
    header_.info.max_height = root.max_height;
    header_.info.checksum = grid_checksum_.hex();
    write_index();
    pending_.finish();
    pending_.publish();
    return header_.info;
}

void StoreWriter::write_index() {
    std::array<std::byte, kStoreHeaderBytes> header = encode_header(header_);
    base::WordHash hash;
    hash.add(std::span(header).first(kStoreHeaderBytes - 8));
    std::uint64_t place = kStoreHeaderBytes;
    const TilePyramid& pyramid = layout_.pyramid();
    std::vector<std::byte> bytes;
    for (int level = 0; level < pyramid.levels(); ++level) {
        for (int row = 0; row < pyramid.rows(level); ++row) {
            bytes.resize(std::size_t(pyramid.columns(level)) * kIndexEntryBytes);
            for (int column = 0; column < pyramid.columns(level); ++column) {
                const TileId tile{level, row, column};
                encode_entry(
                    {layout_.offset(tile), checksums_[pyramid.index(tile)], summaries_.at(tile)},
                    std::span(bytes)
                        .subspan(std::size_t(column) * kIndexEntryBytes)
                        .first<kIndexEntryBytes>());
            }
            hash.add(bytes);
            pending_.write_at(place, bytes);
            place += bytes.size();
        }
    }
    set_checksum(header, hash.value());
    pending_.write_at(0, header);
}

TerrainInfo write_store(const HeightField& field, std::optional<double> step,
                        const std::filesystem::path& file) {
    StoreWriter writer(field.info(), step, file);
    const auto columns = std::size_t(field.info().columns);
    for (int row = 0; row < field.info().rows; ++row) {
        writer.push(field.samples().subspan(std::size_t(row) * columns, columns));
    }
    return writer.finish();
}

}  // namespace lodbench::terrain
