#pragma once
// A frame of hybrid-patches on the CPU: select, keep what holds, refine the rest. No OpenGL.
//
// Source: Loeffler et al. 2010, sections 4.2 and 4.3. Refinement runs in the background from
// `begin` to `finish`, so that the strips that hold can be drawn meanwhile.

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <cstdint>
#include <span>
#include <vector>

#include "common/leb_refiner.h"
#include "hybrid_patches/patch_cache.h"
#include "hybrid_patches/patch_strip.h"

namespace lodbench::hybrid_patches {

/// A strip made for one viewpoint.
struct Refinement {
    std::uint32_t patch = 0;
    std::vector<std::uint16_t> strip;
    std::uint32_t triangles = 0;
    std::size_t tested = 0;
    SphereOfValidity sphere;
};

/// Refines one patch from scratch.
inline void refine(const PatchHierarchy& hierarchy, const LebGrid& grid, const LebView& view,
                   Metric metric, const Camera& camera, std::uint32_t patch, Refinement& result) {
    static thread_local std::vector<std::uint16_t> scratch;
    const auto run = [&](auto test) {
        const std::size_t triangles = PatchStripBuilder<decltype(test)>(scratch).build(
            hierarchy.patch(patch).triangle, hierarchy.segments(), hierarchy.levels(), test);
        result.patch = patch;
        result.strip.assign(scratch.begin(), scratch.end());
        result.triangles = std::uint32_t(triangles);
        result.tested = test.tested();
        result.sphere = {camera.position, camera.forward(), view.scale, test.radius(),
                         metric == Metric::planar ? hierarchy.farthest(patch, view) : 0.0};
    };
    if (metric == Metric::planar) {
        run(ViewTest<Metric::planar>(grid, view, camera.position));
    } else {
        run(ViewTest<Metric::euclidean>(grid, view, camera.position));
    }
}

/// Where in a frame a selected patch's strip comes from.
struct SelectedPatch {
    std::uint32_t patch = 0;
    const PatchCache::Entry* reused = nullptr;  ///< nothing: refined in this frame
    std::uint32_t refinement = 0;               ///< then its index
};

/// Where in a frame a selected patch's strip is.
struct PlacedStrip {
    std::uint32_t patch = 0;
    const PatchCache::Entry* entry = nullptr;  ///< nothing: a refinement without room in the cache
    const Refinement* refinement = nullptr;    ///< nothing: reused
    [[nodiscard]] std::uint32_t triangles() const {
        return refinement != nullptr ? refinement->triangles : entry->triangles;
    }
};

class HybridFrame {
public:
    /// All outlive this. tau > 0 in pixels.
    HybridFrame(const LebGrid& grid, const PatchHierarchy& hierarchy, PatchCache& cache, double tau,
                Metric metric, bool culling)
        : grid_(grid),
          hierarchy_(hierarchy),
          cache_(cache),
          tau_(tau),
          metric_(metric),
          culling_(culling) {}
    ~HybridFrame() { group_.wait(); }
    HybridFrame(const HybridFrame&) = delete;
    HybridFrame& operator=(const HybridFrame&) = delete;

    /// Selects, finds what holds, and starts to refine the rest.
    void begin(const Camera& camera) {
        aim(camera);
        select();
        test_spheres();
        sort_out();
        group_.run([this] { refine_all(); });
    }

    /// Waits for the refinements; helps with them.
    void finish() { group_.wait(); }

    // The steps of `begin`, apart for the benchmark; the last is done when it returns.
    void aim(const Camera& camera) {
        finish();
        camera_ = camera;
        view_ = LebView(grid_, camera, tau_, metric_, 0);
        cache_.begin_frame(view_.scale);
    }
    void select() { hierarchy_.select(view_, metric_, culling_, numbers_); }
    void test_spheres() { cache_.test(numbers_, camera_.position, camera_.forward(), holds_); }
    void sort_out() {
        selected_.clear();
        stale_.clear();
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            const std::uint32_t patch = numbers_[i];
            if (holds_[i] != 0) {
                selected_.push_back({patch, cache_.find(patch), 0});
                continue;
            }
            cache_.drop(patch);
            selected_.push_back({patch, nullptr, std::uint32_t(stale_.size())});
            stale_.push_back(patch);
        }
        if (refinements_.size() < stale_.size()) refinements_.resize(stale_.size());
    }
    void refine_all() {
        tbb::parallel_for(std::size_t(0), stale_.size(), [this](std::size_t i) {
            refine(hierarchy_, grid_, view_, metric_, camera_, stale_[i], refinements_[i]);
        });
    }

    /// After `finish`, once: makes room in the cache for what was refined, and calls
    /// visit(const PlacedStrip&) for each selected patch, in the order of the hierarchy.
    template <typename Visit>
    void place_strips(const Visit& visit) {
        for (const SelectedPatch& patch : selected_) {
            if (patch.reused != nullptr) {
                visit(PlacedStrip{patch.patch, patch.reused, nullptr});
                continue;
            }
            const Refinement& made = refinements_[patch.refinement];
            const PatchCache::Entry* entry = cache_.insert(
                made.patch, made.sphere, std::uint32_t(made.strip.size()), made.triangles);
            visit(PlacedStrip{made.patch, entry, &made});
        }
    }

    /// In the order of the hierarchy.
    [[nodiscard]] std::span<const SelectedPatch> selected() const { return selected_; }
    [[nodiscard]] std::size_t refined() const { return stale_.size(); }

private:
    const LebGrid& grid_;
    const PatchHierarchy& hierarchy_;
    PatchCache& cache_;
    double tau_;
    Metric metric_;
    bool culling_;
    Camera camera_;
    LebView view_{grid_, camera_, 1, Metric::euclidean, 0};
    std::vector<std::uint32_t> numbers_, stale_;
    std::vector<std::uint8_t> holds_;  ///< of numbers_
    std::vector<SelectedPatch> selected_;
    std::vector<Refinement> refinements_;
    tbb::task_group group_;
};

}  // namespace lodbench::hybrid_patches
