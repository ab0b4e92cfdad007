#pragma once
// No crack: every ground, tolerance and frame. For one file of a method's tests, which says its
// methods.

#include <tuple>

#include "support/watertight.h"

namespace lodbench::test {

struct Flown {
    const char* method;
    int base_segments;  ///< of the base mesh
};
inline void PrintTo(const Flown& flown, std::ostream* stream) {
    *stream << flown.method;
}

class Watertight : public WatertightTest,
                   public testing::WithParamInterface<std::tuple<Flown, Ground>> {
protected:
    static Flown flown() { return std::get<0>(GetParam()); }
    static const Ground& ground() { return std::get<1>(GetParam()); }
};

TEST_P(Watertight, at_every_tolerance_and_frame) {
    for (const double tau : {0.25, 1.0, 4.0, 16.0}) {
        for (const int frame : {0, 1, 2})
            expect_watertight(flown().method, "", ground(), tau, frame);
    }
}

TEST_P(Watertight, base_mesh_far_away_at_a_huge_tolerance) {
    expect_base_mesh(flown().method, "", ground(), flown().base_segments);
}

inline std::string name_of(const testing::TestParamInfo<std::tuple<Flown, Ground>>& chosen) {
    return test_name(std::string(std::get<0>(chosen.param).method) + "_" +
                     std::get<1>(chosen.param).name);
}

}  // namespace lodbench::test
