// Triangles that are counted are those that are captured.

#include "support/counted_triangles.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(methods, CountedTriangles,
                         testing::Values(Flyer{"stitching_strips", "dss", {{"tau", "0.1"}}},
                                         Flyer{"stitching_strips", "tess-pow2", {{"tau", "0.1"}}}),
                         [](const testing::TestParamInfo<Flyer>& flyer) {
                             return std::string(flyer.param.method) == "dss" ? "dss" : "tess_pow2";
                         });

}  // namespace
}  // namespace lodbench::test
