#pragma once
// No crack: judged on the exported mesh by a program that shares no code with the method. A choice
// of grounds and tolerances; all of them: watertight_everywhere.h. For one file of a method's
// tests, which says its cases.

#include <vector>

#include "support/watertight.h"

namespace lodbench::test {

struct Case {
    const char* method;
    int patch_samples;  ///< 0: the method has none
    std::vector<const char*> grounds;
    std::vector<double> tolerances;  ///< pixels
    const char* settings = "";
    int base_segments = 1;  ///< of the base mesh; unused for the others
};
struct Cell {
    std::string method;
    int patch_samples;
    Ground ground;
    double tau = 0;  ///< pixels; unused for the base mesh
    std::string more;
    int base_segments = 1;

    [[nodiscard]] std::string settings() const {
        return patch_samples == 0 ? more
                                  : fmt::format("--set patch_samples={} {}", patch_samples, more);
    }
};
inline void PrintTo(const Cell& cell, std::ostream* stream) {
    *stream << cell.method << ' ' << cell.ground.name << ' ' << cell.settings();
}

inline std::vector<Cell> cells_of(const std::vector<Case>& cases) {
    std::vector<Cell> cells;
    for (const Case& one : cases) {
        for (const char* ground : one.grounds) {
            for (const double tau : one.tolerances) {
                cells.push_back({one.method, one.patch_samples, ground_named(ground), tau,
                                 one.settings, one.base_segments});
            }
        }
    }
    return cells;
}

inline std::string name_of(const testing::TestParamInfo<Cell>& chosen) {
    const Cell& cell = chosen.param;
    return test_name(fmt::format("{} {} {} tau {}{}", cell.method, cell.patch_samples,
                                 cell.ground.name, cell.tau,
                                 cell.more.empty() ? "" : " " + cell.more));
}

class Watertight : public WatertightTest, public testing::WithParamInterface<Cell> {};

TEST_P(Watertight, mesh) {
    const Cell& cell = GetParam();
    expect_watertight(cell.method, cell.settings(), cell.ground, cell.tau, 2);
}

inline const std::vector<const char*> kMost = {"plane",      "bump",       "step",  "ridged_odd",
                                               "ridged_2x2", "ridged_3x5", "ridged"};

class BaseMesh : public WatertightTest, public testing::WithParamInterface<Cell> {};

TEST_P(BaseMesh, far_away_at_a_huge_tolerance) {
    const Cell& cell = GetParam();
    expect_base_mesh(cell.method, cell.settings(), cell.ground, cell.base_segments);
}

inline const std::vector<const char*> kFew = {"ridged_2x2", "step", "ridged_oblong"};

}  // namespace lodbench::test
