#pragma once
// Measures the frames that a stage has selected: captures them, checks what was captured, and hands
// surface, depth and pictures to whoever knows the truth.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/truth.h"
#include "measure/whole_heights.h"
#include "run/cell.h"
#include "run/stage.h"
#include "run/view_cache.h"

namespace lodbench::run {

/// The method's parameter that turns leaving out what is out of view off: `culling`, a boolean.
/// nullptr where it has none.
[[nodiscard]] const ParamInfo* culling_param(const MethodInfo& method);

/// The method's background work is paused by the caller while anything here is called.
class FrameMeasurer {
public:
    /// `claimed`: the method's bound in pixels. `truth`: the whole terrain that the stage's is, to
    /// measure against; without it triangles are counted only. `views`: where what a frame shows of
    /// the truth is looked for and kept.
    FrameMeasurer(Stage& stage, std::optional<double> claimed,
                  std::shared_ptr<const terrain::WholeTerrain> truth, ViewCache views = {},
                  measure::Extent extent = measure::Extent::all);

    /// Goes on with another stage of the same method over the same terrain.
    void move_to(Stage& stage) { stage_ = &stage; }

    /// Captures the frozen selection; what popped since the frame before goes into `before`, where
    /// that was measured. Throws MethodFailure for vertices that are not finite and for triangles
    /// that `record` counts and that did not go through gl::Device.
    void take(int frame, const results::FrameRecord& record, results::FrameRecord* before);
    /// Measures the frame that was taken last into its record: the non-degenerate triangles, and
    /// the truth.
    void measure(results::FrameRecord& record);
    /// Of the frame that was measured last, how few triangles would have done.
    void find_economy();
    /// The frozen selection as the real-time replay has it.
    void measure_realtime(int frame);
    /// The height error of the frozen selection over all of the terrain, into its record. Needs the
    /// truth.
    void measure_whole(results::FrameRecord& record);

    /// The truth about the flight; nothing without it.
    void finish(results::CellRecord& cell) const;
    /// The worst frame's picture as PNG; does nothing where no frame was measured.
    void write_picture(const std::filesystem::path& path, const std::string& title) const;
    /// The map of what measure_whole found last, as PNG. `title`: which frame of which cell.
    void write_heights(const std::filesystem::path& path, const std::string& title) const;

private:
    [[nodiscard]] measure::CapturedSurface capture();
    /// Of the sample in the middle of each cell of a map.
    [[nodiscard]] std::vector<float> map_heights(int rows, int columns) const;
    void warn_of_the_whole(results::CellRecord& cell) const;
    [[nodiscard]] measure::ReferenceView reference_view();  ///< of the frame that was taken last

    Stage* stage_;
    std::shared_ptr<const terrain::WholeTerrain> truth_;  ///< outlives the stage
    std::optional<measure::TruthMeter> meter_;
    ViewCache views_;
    measure::Extent extent_;
    std::vector<measure::WholeHeights> whole_;  ///< of each frame that was measured so
    Camera whole_camera_;                       ///< of the last of them
    int frame_ = 0;                             ///< that was taken last
    std::uint64_t nondegenerate_ = 0;           ///< of the frame that was taken last
};

}  // namespace lodbench::run
