// SPDX-License-Identifier: Apache-2.0
// Measures the density of the LF cameras around the lens of a frame, and derives the frame's
// queries: the rays that are interpolated from rebinned rays. Both need only the calibration of the
// LF cameras, no pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/render/settings/rebin_settings.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {

// LF images with rays through the lens, or up to this distance beside it, are near the lens
// (ImagesNearLens()). The kernel of a lens point is not widened further for LF cameras that are
// farther from the point than this distance. The unit is the distance between LF cameras around the
// lens.
inline constexpr double kFarthestDistances = 8;

struct FrameSampling {
  LfSampling lf;  // lf.camera_distance_w is 0 if there is no LF camera around the lens
  // Upper bound of the distance, in world units, from any point of the lens to the nearest point of
  // SeenThrough(); but at most kFarthestDistances times lf.camera_distance_w.
  double hole_w = 0;
  // Distance between neighbouring recorded LF cameras around the lens, in world units; unset unless
  // the light field has virtual LF images.
  std::optional<double> recorded_distance_w = std::nullopt;
};

// Returns the LF images with rays through the lens, or up to kFarthestDistances * camera_distance_w
// beside it, by ascending ranks.
std::vector<SelectedImage> ImagesNearLens(const ImageIndex& index, const RenderCamera& frame,
                                          double camera_distance_w, const SelectOptions& select,
                                          ThreadPool& pool);

// Returns, for each LF image of `near`, the intersection of the lens plane with the line from its
// LF camera to the focus point of the plate's middle. Empty if there is no such focus point.
std::vector<Vec2> SeenThrough(const ImageIndex& index, const RenderCamera& frame,
                              std::span<const SelectedImage> near);

// Measures how densely the LF cameras of `near` sample the lens of a frame.
//   near               the result of ImagesNearLens()
//   camera_distance_w  CameraDistanceAround() (render/collect/around_lens.h) in the whole light
//                      field
FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         std::span<const SelectedImage> near, double camera_distance_w);

// Finds the LF images near the lens of a frame, and measures how densely their LF cameras sample
// it. The result is the same for every estimator: it includes each LF image that has rays for at
// least one estimator.
FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         const SelectOptions& select, ThreadPool& pool);
// Value of SelectOptions::reach that selects the LF images that have rays for at least one
// estimator.
inline constexpr PixelReach kWidestReach = PixelReach::kNeighbours;

// Returns the queries of a frame: the rays through all of its lens points.
// sampling.lf.camera_distance_w must be above 0.
//   seen_through  the result of SeenThrough(): the farther the nearest of these points is from a
//                 lens point, the wider is the kernel of the lens point; unset: sampling.hole_w is
//                 used as this distance
FrameQueries QueriesOf(const RenderCamera& frame, const FrameSampling& sampling,
                       const QueryOptions& options,
                       std::optional<std::span<const Vec2>> seen_through = {});

// Returns the distance from the rim of the lens, in world units, up to which a frame depends on LF
// cameras beside the lens. These are the LF cameras whose rays are rebinned with the default
// QueryOptions, and those that limit the lens weights of LF cameras nearer to the lens. 0 if there
// are no LF cameras around the lens.
double NeighbourReach_w(const RenderCamera& frame, const FrameSampling& sampling);

}  // namespace lf
