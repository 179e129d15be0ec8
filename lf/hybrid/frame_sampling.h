// The density of LF cameras around the lens of a frame, and what the frame therefore asks rebinned
// rays for. Both follow from calibrations alone.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/rebinning/slab_plan.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {

// Rays of LF cameras farther than this from a lens point have no say in what it sees. In distances
// between LF cameras around the lens.
inline constexpr double kFarthestDistances = 8;

struct FrameSampling {
  LfSampling lf;      // camera_distance_w is 0 if no LF camera is around the lens
  double hole_w = 0;  // from any point of the lens to the nearest LF camera, at most
};

// Returns the LF images with rays within kFarthestDistances of the lens, by ascending places.
std::vector<SelectedImage> ImagesNearLens(const ImageIndex& index, const RenderCamera& frame,
                                          double camera_distance_w, const SelectOptions& select,
                                          ThreadPool& pool);

// Returns the lens points through which LF cameras see what the middle of the plate is focused on.
std::vector<Vec2> SeenThrough(const ImageIndex& index, const RenderCamera& frame,
                              std::span<const SelectedImage> near);

//   near               ImagesNearLens()
//   camera_distance_w  CameraDistanceAround() (collector/around_lens.h) in the whole light field
FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         std::span<const SelectedImage> near, double camera_distance_w);

// The same for any estimator: with those LF images near the lens that have rays for some estimator.
FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         const SelectOptions& select, ThreadPool& pool);
// select.reach of these.
inline constexpr PixelReach kWidestReach = PixelReach::kNeighbours;

struct QueryOptions {
  double sigma_st = 0.5;     // in distances between LF cameras; wider where these are rare
  double sigma_uv = 0.35;    // in elements, or in LF pixels where these are larger
  int lens_point_count = 0;  // in a set; 0: so many that kernels overlap, 8 to 256
  int lens_sets = 1;         // k: sets of k x k elements (lens_points.h)
  uint64_t seed = 0;
};

// Returns what the frame asks for: rays through all of its lens points. The sampling must have LF
// cameras.
//   seen_through  SeenThrough(): a kernel is as wide as the way to the nearest wants; none: the
//                 widest that hole_w allows, for every point
FrameQueries QueriesOf(const RenderCamera& frame, const FrameSampling& sampling,
                       const QueryOptions& options,
                       std::optional<std::span<const Vec2>> seen_through = {});

// Returns how far beyond the rim of the lens the LF cameras stand that rebinned rays of the default
// options are made of, at most, and those that lens weights are measured against.
double NeighbourReach_w(const RenderCamera& frame, const FrameSampling& sampling);

}  // namespace lf
