// Methods of longest-edge bisection leave no crack: every ground, tolerance and frame.

#include <tuple>

#include "support/watertight.h"

namespace lodbench::test {
namespace {

class Watertight : public WatertightTest,
                   public testing::WithParamInterface<std::tuple<const char*, Ground>> {
protected:
    static std::string method() { return std::get<0>(GetParam()); }
    static const Ground& ground() { return std::get<1>(GetParam()); }
};

TEST_P(Watertight, at_every_tolerance_and_frame) {
    for (const double tau : {0.25, 1.0, 4.0, 16.0}) {
        for (const int frame : {0, 1, 2}) expect_watertight(method(), "", ground(), tau, frame);
    }
}

TEST_P(Watertight, base_mesh_far_away_at_a_huge_tolerance) {
    expect_base_mesh(method(), "", ground(), 65);
}

INSTANTIATE_TEST_SUITE_P(methods, Watertight,
                         testing::Combine(testing::Values("lindstrom", "hybrid-patches",
                                                          "static-patches", "dltq", "sltq-cpu",
                                                          "fu"),
                                          testing::ValuesIn(kGrounds)),
                         [](const auto& chosen) {
                             return test_name(std::string(std::get<0>(chosen.param)) + "_" +
                                              std::get<1>(chosen.param).name);
                         });

}  // namespace
}  // namespace lodbench::test
