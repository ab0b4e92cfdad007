// The methods of this room and their parameters; README.md says more of both.

#include "stitching_strips/methods.h"

namespace lodbench::stitching_strips {
namespace {

constexpr const char* kCitation =
    "L. Zhang, J. She, J. Tan, B. Wang, Y. Sun, 2019, A Multilevel Terrain Rendering Method Based "
    "on Dynamic Stitching Strips";

constexpr ParamSpec kTau = real_param("tau", 1, 0.01, 1000, "screen-space error threshold, pixels");
constexpr ParamSpec kError = choice_param(
    "error", "average", "average|max",
    "object-space error of a block over its samples: the paper's mean, or the greatest");
constexpr ParamSpec kViewAngle = boolean_param(
    "view_angle", true,
    "an error counts as long as the angle of view makes it: sin(theta) of equation (3)");
constexpr ParamSpec kStraightDown =
    choice_param("straight_down", "block", "block|zero",
                 "sin(theta) of a block straight below: at least that of its border, or 0 as "
                 "equation (3) has it");
constexpr ParamSpec kDistance =
    choice_param("distance", "centre", "centre|box",
                 "from the viewpoint to the block's centre, as the paper, or to its bounding box");
constexpr ParamSpec kCulling =
    boolean_param("culling", true, "leaves out what is outside the view frustum or the terrain");

constexpr ParamSpec kDssParams[] = {
    kTau,
    kError,
    kViewAngle,
    kStraightDown,
    kDistance,
    kCulling,
    integer_param("strip_width", 1, 0, 64,
                  "width of a strip in cells; 0: one segment of the blocks beside it at factor 64, "
                  "at least one cell"),
    integer_param("threads", 0, 0, 64,
                  "threads that build strips; 0: as many as there are processors")};
constexpr ParamSpec kPow2Params[] = {
    kTau,
    kError,
    kViewAngle,
    kStraightDown,
    kDistance,
    kCulling,
    choice_param("round", "down", "down|up", "to which power of two a factor is rounded")};

constexpr ParamSpec kUniformParams[] = {
    real_param("tau", 1, 0.01, 1000,
               "pixels: screen-space error threshold, or with metric = edge_length a segment's "
               "length"),
    kError,
    kViewAngle,
    kCulling,
    integer_param("block_cells", 0, 0, 4096,
                  "cells along a block's side; 0: an eighth of the terrain's longer side, at most "
                  "128"),
    choice_param("metric", "error", "error|edge_length",
                 "what a factor follows from: the error of its edge or block, or how long its edge "
                 "is on screen")};

constexpr MethodDescriptor kMethods[] = {
    {.id = "dss",
     .title = "Zhang et al.: tessellated blocks with continuous factors, stitched by strips that "
              "are made in each frame",
     .citation = kCitation,
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kDssParams,
     .param_count = std::size(kDssParams),
     .quality_knob = "tau",
     .claimed_bound = nullptr,
     .create = create_dss,
     .destroy = destroy_method},
    {.id = "tess-pow2",
     .title = "Zhang et al.'s Method I: a quadtree of tessellated blocks with powers of two for "
              "factors",
     .citation = kCitation,
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kPow2Params,
     .param_count = std::size(kPow2Params),
     .quality_knob = "tau",
     .claimed_bound = nullptr,
     .create = create_tess_pow2,
     .destroy = destroy_method},
    {.id = "tess-uniform",
     .title =
         "Zhang et al.'s Method II: blocks of equal size, tessellated by continuous factors of "
         "their edges",
     .citation = kCitation,
     .version = "1",
     .capabilities = 0,
     .gl_extensions = nullptr,
     .params = kUniformParams,
     .param_count = std::size(kUniformParams),
     .quality_knob = "tau",
     .claimed_bound = nullptr,
     .create = create_tess_uniform,
     .destroy = destroy_method}};

}  // namespace
}  // namespace lodbench::stitching_strips

LODBENCH_PLUGIN(lodbench::stitching_strips::kMethods);
