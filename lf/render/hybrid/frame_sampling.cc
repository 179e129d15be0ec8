// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/frame_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/core/check.h"
#include "lf/core/median.h"
#include "lf/rebinning/splat.h"
#include "lf/render/collect/around_lens.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {
namespace {

// Distance between lens points, in sigmas of their kernels, at which the kernels just overlap.
constexpr double kPointDistance_sigmas = 3;
constexpr int kLeastPoints = 8, kMostPoints = 256;
// Sigma of the kernel of a lens point far from LF cameras, as a share of the distance to the
// nearest LF camera.
constexpr double kSigmaPerDistance = 0.5;
// Largest sigma of a kernel on the plate that frames use, in elements; must be below
// kMostSigmaUv_px, for which splats have memory (rebinning/splat_tile.h).
constexpr double kMostUsedSigmaUv_px = 8;

double NearestOf(std::span<const Vec2> seen_through, const Vec2& point) {
  double nearest_w = std::numeric_limits<double>::infinity();
  for (const Vec2& other : seen_through) nearest_w = std::min(nearest_w, (other - point).norm());
  return nearest_w;
}

// Returns FrameSampling::hole_w before it is limited. Measures it at some points of the lens, and
// adds the distance between these points as a margin.
double HoleOf(const RenderCamera& frame, std::span<const Vec2> seen_through) {
  constexpr int kAsked = 64;
  const LensPointSets points = MakeLensPoints(frame.aperture, kAsked, 1, 0);
  double hole_w = 0;
  for (const Vec2& point : points.sets.front())
    hole_w = std::max(hole_w, NearestOf(seen_through, point));
  return hole_w + std::sqrt(Area(frame.aperture) / kAsked);
}

// Returns the width of an LF pixel at the focus distance, in elements; at least 1.
double LfPixelsPerElement(const RenderCamera& frame, const LfSampling& sampling) {
  const Intrinsics& plate = frame.pinhole.intrinsics;
  const std::optional<Vec3> focus =
      FocusPointOfElement(frame, 0.5 * plate.width_px, 0.5 * plate.height_px);
  if (!focus) return 1;
  const Vec3 forward = frame.pinhole.ForwardWorld();
  const double lf_pixel_w =
      sampling.pixel_rad * std::abs(forward.dot(*focus - sampling.middle_world));
  const double element_w = forward.dot(*focus - frame.pinhole.CentreWorld()) / plate.fx_px;
  return std::max(1.0, lf_pixel_w / element_w);
}

}  // namespace

std::vector<SelectedImage> ImagesNearLens(const ImageIndex& index, const RenderCamera& frame,
                                          double camera_distance_w, const SelectOptions& select,
                                          ThreadPool& pool) {
  RenderCamera grown = frame;
  OpenUpTo(frame.aperture.radius_w + kFarthestDistances * camera_distance_w, &grown);
  return SelectImages(index, std::span(&grown, 1), select, pool);
}

std::vector<Vec2> SeenThrough(const ImageIndex& index, const RenderCamera& frame,
                              std::span<const SelectedImage> near) {
  const Intrinsics& plate = frame.pinhole.intrinsics;
  const std::optional<Vec3> focus =
      FocusPointOfElement(frame, 0.5 * plate.width_px, 0.5 * plate.height_px);
  std::vector<Vec2> points;
  if (!focus) return points;
  for (const SelectedImage& image : near)
    points.push_back(
        LensPointOfLine(frame, index.light_field().Camera(image.id).CentreWorld(), *focus));
  return points;
}

FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         std::span<const SelectedImage> near, double camera_distance_w) {
  FrameSampling sampling;
  if (&index.recorded() != &index)
    sampling.recorded_distance_w = CameraDistanceAround(index.recorded(), frame);
  if (near.empty() || !(camera_distance_w > 0)) return sampling;
  sampling.lf.camera_distance_w = camera_distance_w;
  std::vector<double> pixel_rad;
  for (const SelectedImage& image : near) {
    const PinholeCamera lf_camera = index.light_field().Camera(image.id);
    pixel_rad.push_back(1 / lf_camera.intrinsics.fx_px);
    sampling.lf.middle_world += lf_camera.CentreWorld();
  }
  sampling.lf.middle_world /= static_cast<double>(near.size());
  sampling.lf.pixel_rad = Median(std::move(pixel_rad));
  sampling.hole_w = std::min(HoleOf(frame, SeenThrough(index, frame, near)),
                             kFarthestDistances * camera_distance_w);
  return sampling;
}

FrameSampling SamplingOf(const ImageIndex& index, const RenderCamera& frame,
                         const SelectOptions& select, ThreadPool& pool) {
  const double distance_w = CameraDistanceAround(index, frame);
  if (!(distance_w > 0)) return SamplingOf(index, frame, {}, 0);
  SelectOptions widest = select;
  widest.reach = kWidestReach;
  return SamplingOf(index, frame, ImagesNearLens(index, frame, distance_w, widest, pool),
                    distance_w);
}

FrameQueries QueriesOf(const RenderCamera& frame, const FrameSampling& sampling,
                       const QueryOptions& options,
                       std::optional<std::span<const Vec2>> seen_through) {
  LF_CHECK(sampling.lf.camera_distance_w > 0);
  FrameQueries queries;
  queries.camera = frame;
  queries.sampling = sampling.lf;
  const double area_w2 = Area(frame.aperture);
  const double sigma_w = options.sigma_st * sampling.lf.camera_distance_w;
  const double apart_w = kPointDistance_sigmas / 2 * sigma_w;
  int count = options.lens_point_count;
  if (count == 0)
    count = static_cast<int>(std::clamp(std::ceil(area_w2 / (kPi * apart_w * apart_w)),
                                        0.0 + kLeastPoints, 0.0 + kMostPoints));
  queries.points = MakeLensPoints(frame.aperture, count, options.lens_sets, options.seed);
  queries.kernel = {sigma_w, std::min(options.sigma_uv * LfPixelsPerElement(frame, sampling.lf),
                                      kMostUsedSigmaUv_px)};
  // The kernel of a lens point is widened if there are so few points that each represents a large
  // part of the lens, or if the nearest LF camera is far from the point.
  const double few = 0.5 * std::sqrt(area_w2 / count) / sigma_w;
  const double most_w = kFarthestDistances * sampling.lf.camera_distance_w;
  for (const auto& set : queries.points.sets) {
    queries.points.spreads.emplace_back();
    for (const Vec2& point : set) {
      const double nearest_w =
          seen_through ? std::min(NearestOf(*seen_through, point), most_w) : sampling.hole_w;
      queries.points.spreads.back().push_back(
          std::max({1.0, few, kSigmaPerDistance * nearest_w / sigma_w}));
    }
  }
  return queries;
}

double NeighbourReach_w(const RenderCamera& frame, const FrameSampling& sampling) {
  if (!(sampling.lf.camera_distance_w > 0)) return 0;
  const FrameQueries queries = QueriesOf(frame, sampling, {});
  return std::max(kFarthestDistances * sampling.lf.camera_distance_w,
                  ReachOf(queries.kernel, queries.points).lens_w);
}

}  // namespace lf
