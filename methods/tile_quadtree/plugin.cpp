// The methods of this room and their parameters; README.md says more of both.

#include "tile_quadtree/methods.h"

namespace lodbench::tile_quadtree {
namespace {

constexpr ParamSpec kTau = real_param("tau", 1, 0.01, 1000, "screen-space error tolerance, pixels");
constexpr ParamSpec kCulling =
    boolean_param("culling", true, "leaves out tiles outside the view frustum");
constexpr ParamSpec kCracks =
    choice_param("cracks", "snap", "snap|skirt|none",
                 "snap: border vertices move onto the coarser neighbour's; skirt: upright strips "
                 "hang from the borders; none: gaps stay");
constexpr ParamSpec kSharedHeight =
    choice_param("shared_height", "none", "range|triangle|none",
                 "(12), one number for a tile's error and the height of its cuboid: its height "
                 "range, or the relief of its triangles; none: the error is apart from the height");
constexpr ParamSpec kErrors = choice_param(
    "errors", "summaries", "summaries|gpu",
    "summaries: a tile's error is the terrain's; gpu: it is computed on the GPU from the heights "
    "of its children where they are resident. Not with shared_height = range");
constexpr ParamSpec kPoolTiles =
    integer_param("pool_tiles", 256, 2, 2048, "tiles that are resident at most, 16.5 KiB each");
constexpr ParamSpec kLoaderThreads =
    integer_param("loader_threads", 2, 1, 16, "threads that read tiles");
constexpr ParamSpec kUploads =
    integer_param("uploads_per_frame", 16, 1, 2048,
                  "tiles that go to the GPU in a frame at most; without limit in lockstep");
constexpr ParamSpec kPrefetch =
    integer_param("prefetch", 8, 0, 600,
                  "frames ahead for which tiles are read, by the viewpoint's movement; 0: none");
constexpr ParamSpec kEvaluate = choice_param("evaluate", "fragment", "fragment|compute",
                                             "how the GPU decides: the paper's fragment pass, or a "
                                             "compute pass");
constexpr ParamSpec kSync =
    boolean_param("sync", false,
                  "waits for the visible region and the decisions, as the paper does; false: those "
                  "of a frame before are used");
constexpr ParamSpec kRegionPixels = integer_param(
    "region_pixels", 64, 8, 512, "edge of the target into which the visible region is drawn");

constexpr ParamSpec kDltqParams[] = {
    kTau,
    kSharedHeight,
    kCracks,
    kCulling,
    kPoolTiles,
    kLoaderThreads,
    kUploads,
    kPrefetch,
    kEvaluate,
    kErrors,
    kSync,
    kRegionPixels,
    integer_param("upper_levels", 4, 0, 12,
                  "levels below the root that the upper tree has; the whole tree's where fewer"),
    boolean_param("prune", false,
                  "leaves out lower trees that the metric, on the CPU, does not refine; false: as "
                  "in the paper all whose root is visible")};
constexpr ParamSpec kSltqGpuParams[] = {kTau,       kSharedHeight,  kCracks,  kCulling,
                                        kPoolTiles, kLoaderThreads, kUploads, kPrefetch,
                                        kEvaluate,  kErrors,        kSync,    kRegionPixels};
constexpr ParamSpec kSltqCpuParams[] = {
    kTau,
    kSharedHeight,
    kCracks,
    kCulling,
    kPoolTiles,
    kLoaderThreads,
    kUploads,
    kPrefetch,
    boolean_param("shortcut", false,
                  "judges only tiles whose ancestors split; false: as in the paper all in view")};
constexpr ParamSpec kFuParams[] = {kTau,       kSharedHeight,  kCracks,      kCulling,
                                   kPoolTiles, kLoaderThreads, kUploads,     kPrefetch,
                                   kEvaluate,  kSync,          kRegionPixels};

constexpr const char* kCitation =
    "Y. Yang, C. Wang, Y. Gao, J. Xing, 2016, Large Scale Terrain Real-Time Rendering on GPU Using "
    "Double Layers Tile Quad Tree and Cuboids Bounding Error Metric";
constexpr std::uint32_t kCapabilities = kAsynchronous | kOutOfCore | kSkirts;

constexpr MethodDescriptor kMethods[] = {
    {.id = "dltq",
     .title = "Yang et al.: double-layer tile quadtree, cuboid error metric on the GPU",
     .citation = kCitation,
     .version = "2",
     .capabilities = kCapabilities,
     .gl_extensions = nullptr,
     .params = kDltqParams,
     .param_count = std::size(kDltqParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_dltq,
     .destroy = destroy_method},
    {.id = "sltq-gpu",
     .title = "Yang et al.'s comparator: single-layer tile quadtree, cuboid error metric on the "
              "GPU",
     .citation = kCitation,
     .version = "2",
     .capabilities = kCapabilities,
     .gl_extensions = nullptr,
     .params = kSltqGpuParams,
     .param_count = std::size(kSltqGpuParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_sltq_gpu,
     .destroy = destroy_method},
    {.id = "sltq-cpu",
     .title = "Yang et al.'s comparator: single-layer tile quadtree, all on the CPU",
     .citation = kCitation,
     .version = "2",
     .capabilities = kCapabilities,
     .gl_extensions = nullptr,
     .params = kSltqCpuParams,
     .param_count = std::size(kSltqCpuParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_sltq_cpu,
     .destroy = destroy_method},
    {.id = "fu",
     .title = "Yang et al.'s comparator after Fu Wei et al. 2012: saturated errors and nested "
              "spheres, decided on the GPU",
     .citation = kCitation,
     .version = "2",
     .capabilities = kCapabilities,
     .gl_extensions = nullptr,
     .params = kFuParams,
     .param_count = std::size(kFuParams),
     .quality_knob = "tau",
     .claimed_bound = "tau",
     .create = create_fu,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::tile_quadtree

LODBENCH_PLUGIN(lodbench::tile_quadtree::kMethods);
