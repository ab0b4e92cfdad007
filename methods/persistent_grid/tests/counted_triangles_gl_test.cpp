#include "support/counted_triangles.h"

namespace lodbench::test {
namespace {

INSTANTIATE_TEST_SUITE_P(methods, CountedTriangles,
                         testing::Values(Flyer{"persistent_grid", "pgm"}), plugin_of);

}  // namespace
}  // namespace lodbench::test
