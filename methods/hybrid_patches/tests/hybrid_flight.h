#pragma once
// hybrid-patches flown without a GPU.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "common/tests/leb_mesh.h"
#include "hybrid_patches/hybrid_frame.h"

namespace lodbench::hybrid_patches {

using common::ErrorKind;
using common::LebRefiner;
using common::RefinerOptions;
using test::Mesh;

inline std::vector<RefinerOptions> all_options(double tau) {
    std::vector<RefinerOptions> all;
    for (const ErrorKind error : {ErrorKind::midpoint, ErrorKind::accumulated}) {
        for (const Metric metric : {Metric::euclidean, Metric::planar}) {
            all.push_back({tau, error, metric, false});
        }
    }
    return all;
}

inline test::Terrains terrains() {
    test::Terrains all;
    all.push_back(test::random_terrain(65, 65, 1));
    all.push_back(test::random_terrain(100, 37, 2, {10, 3}));
    all.push_back(test::random_terrain(2, 2, 3));
    all.push_back(test::random_terrain(9, 5, 4));
    all.push_back(test::step_terrain(40, 65));
    all.push_back(test::plane_terrain(33, 33));
    return all;
}

/// A terrain with all that hybrid-patches has but the GPU, whose cache is played by an array.
class Flight {
public:
    Flight(const Terrain& terrain, const RefinerOptions& options, int segments,
           std::size_t cache_bytes)
        : options_(options),
          refiner_(terrain, options),
          hierarchy_(refiner_.grid(), segments, terrain.info().rows, terrain.info().columns),
          cache_(hierarchy_.size(), cache_bytes, options.metric),
          buffer_(cache_bytes / 2),
          frame_(refiner_.grid(), hierarchy_, cache_, options.tau, options.metric,
                 options.culling) {}

    /// What is drawn: patch and strip, in the order of the hierarchy.
    struct Drawn {
        std::uint32_t patch;
        std::vector<std::uint16_t> strip;
        bool reused;
    };

    std::vector<Drawn> fly(const Camera& camera) {
        frame_.begin(camera);
        frame_.finish();
        std::vector<Drawn> drawn;
        std::vector<const PatchCache::Entry*> entries;
        frame_.place_strips([&](const PlacedStrip& placed) {
            drawn.push_back({placed.patch, {}, placed.refinement == nullptr});
            entries.push_back(placed.entry);
            if (placed.refinement != nullptr) {
                const Refinement& made = *placed.refinement;
                spheres_[placed.patch] = made.sphere;
                made_for_[placed.patch] = camera;
                drawn.back().strip = made.strip;
                if (placed.entry != nullptr) {
                    std::copy(made.strip.begin(), made.strip.end(),
                              buffer_.begin() + std::ptrdiff_t(placed.entry->block.offset / 2));
                } else {
                    ++streamed;
                }
            }
        });
        // As the GPU reads them: after all of this frame was written.
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            if (entries[i] == nullptr) continue;
            const auto first = buffer_.begin() + std::ptrdiff_t(entries[i]->block.offset / 2);
            drawn[i].strip.assign(first, first + entries[i]->index_count);
        }
        return drawn;
    }

    [[nodiscard]] std::vector<test::Triangle> triangles(const std::vector<Drawn>& drawn) const {
        std::vector<test::Triangle> all;
        for (const Drawn& patch : drawn) {
            const auto more = test::expand(vertices_of(patch.patch, patch.strip));
            all.insert(all.end(), more.begin(), more.end());
        }
        return all;
    }
    /// Indices in the grid of vertices that are named within the patch.
    [[nodiscard]] std::vector<std::uint32_t> vertices_of(
        std::uint32_t patch, std::span<const std::uint16_t> names) const {
        const Triangle& t = hierarchy_.patch(patch).triangle;
        const int segments = hierarchy_.segments();
        std::vector<std::uint32_t> vertices;
        for (const int name : names) {
            const int a = name / (segments + 1);
            const int b = name % (segments + 1);
            const int row = a * (t.left.row - t.apex.row) + b * (t.right.row - t.apex.row);
            const int column =
                a * (t.left.column - t.apex.column) + b * (t.right.column - t.apex.column);
            EXPECT_EQ(row % segments, 0);
            EXPECT_EQ(column % segments, 0);
            vertices.push_back(std::uint32_t(refiner_.grid().index(
                {t.apex.row + row / segments, t.apex.column + column / segments})));
        }
        return vertices;
    }
    [[nodiscard]] Refinement from_scratch(std::uint32_t patch, const Camera& camera) const {
        Refinement result;
        refine(hierarchy_, refiner_.grid(), refiner_.view(camera), options_.metric, camera, patch,
               result);
        return result;
    }
    [[nodiscard]] std::vector<std::uint32_t> corners(const std::vector<Drawn>& drawn) const {
        std::vector<std::uint32_t> all;
        for (const Drawn& patch : drawn) {
            const Triangle& t = hierarchy_.patch(patch.patch).triangle;
            for (const Sample s : {t.left, t.apex, t.right}) {
                all.push_back(std::uint32_t(refiner_.grid().index(s)));
            }
        }
        return all;
    }
    [[nodiscard]] const LebRefiner& refiner() const { return refiner_; }
    [[nodiscard]] const PatchHierarchy& hierarchy() const { return hierarchy_; }
    [[nodiscard]] const PatchCache& cache() const { return cache_; }
    [[nodiscard]] HybridFrame& frame() { return frame_; }
    /// By patch: how far the strip of its last refinement holds.
    [[nodiscard]] const std::map<std::uint32_t, SphereOfValidity>& spheres() const {
        return spheres_;
    }
    /// The camera for which the patch was refined last.
    [[nodiscard]] const Camera& made_for(std::uint32_t patch) const { return made_for_.at(patch); }
    int streamed = 0;

private:
    RefinerOptions options_;
    LebRefiner refiner_;
    PatchHierarchy hierarchy_;
    PatchCache cache_;
    std::vector<std::uint16_t> buffer_;
    std::map<std::uint32_t, Camera> made_for_;
    std::map<std::uint32_t, SphereOfValidity> spheres_;  ///< by patch, of the last refinement
    HybridFrame frame_;
};

}  // namespace lodbench::hybrid_patches
