#pragma once
// What was flown for a paper, asked for figures of selected cells.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "reproduce/paper.h"
#include "results/cell.h"

namespace lodbench::reproduce {

/// The results of one experiment.
struct FlownExperiment {
    std::vector<results::CellRecord> cells;
    std::map<std::string, results::FrameTable> frames;  ///< by cell, of those that are ok
    bool software = false;                              ///< by a software rasteriser
    std::string device;                                 ///< "" where nothing came so far
    std::string failure;                ///< why nothing was flown; "" where something was
    std::vector<std::string> terrains;  ///< in words
    /// Methods that say nothing, and why: not here, or not what they were to be equal at.
    std::map<std::string, std::string> unusable;
};

/// A figure of one setting over its repetitions.
struct Measured {
    std::optional<Interval> value;
    std::string why_not;  ///< why there is no value, or why nothing can be decided by it
    std::set<std::string> cells = {};  ///< it is of these: "EXPERIMENT/CELL"
};

/// A column along the flight, of one setting.
struct MeasuredCurve {
    std::vector<double> values;  ///< a frame each, the median over the repetitions; nan: none
    std::string why_not;         ///< why there are none
};

class Evidence {
public:
    std::map<std::string, FlownExperiment> experiments;  ///< by id

    /// From five repetitions on the bootstrap interval of the median, below that the range. No
    /// value where a cell of the setting is missing or failed, and where the figure was not
    /// measured. A time that was measured once has a value and a reason: nothing is known of its
    /// noise. Throws InputError, beginning with `where`, for a selection that names no experiment,
    /// that is met by several settings, or by none although its method was flown.
    [[nodiscard]] Measured measure(const Figure& figure, const Selection& selection,
                                   const std::string& where) const;
    /// Of frames, as `measure` selects and refuses.
    [[nodiscard]] MeasuredCurve curve(const std::string& column, const Selection& selection,
                                      const std::string& where) const;
    [[nodiscard]] bool any_in_software() const;

private:
    struct Selected {
        const FlownExperiment* flown = nullptr;
        std::vector<const results::CellRecord*> cells = {};  ///< its repetitions, all ok
        std::set<std::string> names = {};                    ///< of all that were selected
        std::string why_not = {};                            ///< why there are no cells
    };
    [[nodiscard]] Selected select(const Selection& selection, const std::string& where) const;
    [[nodiscard]] static CellWithFrames with_frames(const FlownExperiment& flown,
                                                    const results::CellRecord& cell);
};

}  // namespace lodbench::reproduce
