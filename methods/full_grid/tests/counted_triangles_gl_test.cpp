#include "support/counted_triangles.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(methods, CountedTriangles,
                         testing::Values(Flyer{"full_grid", "full-grid"}), plugin_of);

}  // namespace
}  // namespace lodbench::test
