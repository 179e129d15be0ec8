// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/frame_density.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/render/collect/around_lens.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {
namespace {

constexpr double kBefore = 0.75, kBehind = 1.25;  // assumed depths divided by the focus distance
// Positions of the elements for FrameDensity::least_aperture_w, as shares of the plate's sides.
constexpr double kPlaces[] = {1.0 / 6, 0.5, 5.0 / 6};

// The LF cameras around the lens, and their positions.
struct Around {
  std::vector<LfImageId> ids;
  std::vector<Vec3> centres_world;
};

// Returns the distance, in the lens plane, from the lens centre to the nearest ray that an LF
// camera recorded from the focus point of the element at (x_px, y_px). Returns 0 if the element has
// no focus point, infinity if no LF camera sees the focus point.
double NearestRay(const LightField& light_field, const Around& around, const RenderCamera& frame,
                  double x_px, double y_px) {
  double nearest_w = std::numeric_limits<double>::infinity();
  const std::optional<Vec3> focus = FocusPointOfElement(frame, x_px, y_px);
  if (!focus) return 0;  // the element is beyond the horizon of a tilted focus plane
  for (size_t i = 0; i < around.ids.size(); ++i) {
    const double distance_w = LensPointOfLine(frame, around.centres_world[i], *focus).norm();
    // IsSeenBy() is slow, so it is called only for rays nearer than all previous ones.
    if (distance_w < nearest_w &&
        IsSeenBy(RayThrough(light_field.Camera(around.ids[i]), frame.pinhole.ForwardWorld()),
                 *focus))
      nearest_w = distance_w;
  }
  return nearest_w;
}

// Converts depths along the axes of the LF cameras around the lens to depths along the frame's
// axis.
DepthRange DepthsOfFrame(const DepthRange& depths, const Around& around,
                         const RenderCamera& frame) {
  double shift_w = 0;
  for (const Vec3& centre : around.centres_world)
    shift_w += frame.pinhole.ForwardWorld().dot(centre - frame.pinhole.CentreWorld()) /
               static_cast<double>(around.centres_world.size());
  // The shifted depths are raised to at least a tenth of depths.near_w, so that they stay positive.
  const double least_w = 0.1 * depths.near_w;
  return {std::max(least_w, depths.near_w + shift_w), std::max(least_w, depths.far_w + shift_w)};
}

}  // namespace

double FrameDensity::MostDisplacement_px() const {
  return std::max(near_displacement_px, far_displacement_px);
}
double FrameDensity::DepthOfMost_w() const {
  return near_displacement_px >= far_displacement_px ? depths.near_w : depths.far_w;
}

bool WantsVirtual(const FrameDensity& density, bool has_virtual) {
  return !has_virtual && density.MostDisplacement_px() > kDoubleEdge_px;
}

FrameDensity DensityOf(const ImageIndex& index, const RenderCamera& frame,
                       const std::optional<DepthRange>& depths) {
  FrameDensity density;
  const Intrinsics& plate = frame.pinhole.intrinsics;
  Around around;
  around.ids = CamerasAroundLens(index, frame, true);
  for (const LfImageId id : around.ids)
    around.centres_world.push_back(index.light_field().Camera(id).CentreWorld());
  density.camera_distance_w = index.light_field().encoding.masks_clipped
                                  ? CameraDistance(frame, DistinctPlaces(around.centres_world))
                                  : CameraDistance(frame, around.centres_world);

  const std::optional<Vec3> focus =
      FocusPointOfElement(frame, 0.5 * plate.width_px, 0.5 * plate.height_px);
  std::vector<Vec2> points;
  for (const Vec3& centre : around.centres_world) {
    if (!focus) break;
    const Vec2 point = LensPointOfLine(frame, centre, *focus);
    if (!point.allFinite()) continue;
    points.push_back(point);
    density.cameras_in_lens += Contains(frame.aperture, point) ? 1 : 0;
  }
  density.coverage = CoverageOf(points, frame.aperture);

  for (const double x : kPlaces)
    for (const double y : kPlaces)
      density.least_aperture_w = std::max(density.least_aperture_w,
                                          2 * NearestRay(index.light_field(), around, frame,
                                                         x * plate.width_px, y * plate.height_px));
  constexpr double kRounding = 1e-6;
  if (density.least_aperture_w < kRounding * density.camera_distance_w)
    density.least_aperture_w = 0;

  const double focus_w = frame.focus_distance_w;
  density.depths = depths && !around.ids.empty() ? DepthsOfFrame(*depths, around, frame)
                                                 : DepthRange{kBefore * focus_w, kBehind * focus_w};
  const auto displacement = [&](double z_w) {
    return plate.fx_px * density.camera_distance_w * std::abs(1 / z_w - 1 / focus_w);
  };
  density.near_displacement_px = displacement(density.depths.near_w);
  density.far_displacement_px = displacement(density.depths.far_w);
  return density;
}

}  // namespace lf
