// The methods of this room and their parameters; README.md says more of both.

#include "hybrid_patches/methods.h"

namespace lodbench::hybrid_patches {
namespace {

constexpr ParamSpec kTau = real_param("tau", 1, 0.01, 1000, "screen-space error tolerance, pixels");
constexpr ParamSpec kError = choice_param("error", "midpoint", "midpoint|accumulated",
                                          "object-space error: the paper's maximum of midpoint "
                                          "errors, or the largest sum along a path of "
                                          "descendants, which bounds the surface");
constexpr ParamSpec kMetric =
    choice_param("metric", "euclidean", "euclidean|planar",
                 "distance: the paper's to the eye, or the depth with the image corner's secant, "
                 "which bounds the error on a flat image");
constexpr ParamSpec kCulling =
    boolean_param("culling", true, "leaves out patches outside the view frustum or the terrain");
constexpr ParamSpec kPatchSamples = choice_param(
    "patch_samples", "65", "9|17|33|65", "samples on each edge of a patch's regular triangulation");

constexpr ParamSpec kStaticParams[] = {kTau, kError, kMetric, kCulling, kPatchSamples};

constexpr ParamSpec kHybridParams[] = {
    kTau,
    kError,
    kMetric,
    kCulling,
    kPatchSamples,
    integer_param("cache_mib", 16, 0, 2048,
                  "size of the cache of triangulations on the GPU, MiB; 0: none")};

constexpr const char* kCitation =
    "F. Loeffler, S. Schwanke, H. Schumann, 2010, A Hybrid Approach for High Quality Real-Time "
    "Terrain Rendering and Optimized A-Priori Error Estimation";

constexpr MethodDescriptor kMethods[] = {
    {.id = "hybrid-patches",
     .title = "Loeffler et al.: patches refined on the CPU, cached while the viewpoint stays in "
              "their sphere of validity",
     .citation = kCitation,
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kHybridParams,
     .param_count = std::size(kHybridParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_hybrid_patches,
     .destroy = destroy_method},
    {.id = "static-patches",
     .title = "Loeffler et al.'s comparator: pre-triangulated patches, selected by nested criteria",
     .citation = kCitation,
     .version = "2",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kStaticParams,
     .param_count = std::size(kStaticParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_static_patches,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::hybrid_patches

LODBENCH_PLUGIN(lodbench::hybrid_patches::kMethods);
