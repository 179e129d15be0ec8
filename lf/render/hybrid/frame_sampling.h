// The density of LF cameras around the lens of a frame, and the rays that the frame therefore asks
// for. Both follow from calibrations alone.
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

// Rays of LF cameras that are farther than this from a lens point do not contribute to its rays. In
// distances between LF cameras around the lens.
inline constexpr double kFarthestDistances = 8;

struct FrameSampling {
  LfSampling lf;      // camera_distance_w is 0 if no LF camera is around the lens
  double hole_w = 0;  // upper bound of the distance from a lens point to the nearest LF camera
};

// Returns the LF images with rays within kFarthestDistances of the lens, by ascending places.
std::vector<SelectedImage> ImagesNearLens(const ImageIndex& index, const RenderCamera& frame,
                                          double camera_distance_w, const SelectOptions& select,
                                          ThreadPool& pool);

// Returns, for each LF image, the lens point on the line from its LF camera to the focus point of
// the middle of the plate.
std::vector<Vec2> SeenThrough(const ImageIndex& index, const RenderCamera& frame,
                              std::span<const SelectedImage> near);

// Returns the sampling around the lens of a frame.
//   near               ImagesNearLens()
//   camera_distance_w  CameraDistanceAround() (render/collect/around_lens.h) in the whole light
//                      field
FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         std::span<const SelectedImage> near, double camera_distance_w);

// Returns the sampling for any estimator: it uses the LF images near the lens that have rays for at
// least one estimator.
FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         const SelectOptions& select, ThreadPool& pool);
// SelectOptions::reach that selects these LF images.
inline constexpr PixelReach kWidestReach = PixelReach::kNeighbours;

struct QueryOptions {
  double sigma_st = 0.5;     // in distances between LF cameras; wider if LF cameras are far away
  double sigma_uv = 0.35;    // in elements, or in LF pixels if these are larger
  int lens_point_count = 0;  // in a set; 0: enough for kernels to overlap, 8 to 256
  int lens_sets = 1;         // k: sets of k x k elements (lens_points.h)
  uint64_t seed = 0;
};

// Returns the queries of a frame: rays through all of its lens points. The sampling must have LF
// cameras.
//   seen_through  SeenThrough(): the width of each point's kernel follows from the distance to the
//                 nearest of these; none: it follows from hole_w
FrameQueries QueriesOf(const RenderCamera& frame, const FrameSampling& sampling,
                       const QueryOptions& options,
                       std::optional<std::span<const Vec2>> seen_through = {});

// Returns the largest distance from the rim of the lens of the LF cameras that a frame depends on:
// those whose rays are rebinned with the default options, and those that lens weights are measured
// against.
double NeighbourReach_w(const RenderCamera& frame, const FrameSampling& sampling);

}  // namespace lf
