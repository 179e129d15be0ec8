// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>

#include "lf/core/log.h"
#include "lf/core/median.h"
#include "lf/densify/camera_lattice.h"
#include "lf/densify/depth_search.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/working_image.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {
namespace {

constexpr int kLeastPlanes = 24, kMostPlanes = 256;
constexpr double kPlaneStep_px = 0.35;
constexpr double kTolerance_px = 0.6;
constexpr double kOutside = 0.5;  // of the median distance between LF cameras

// Limits of the shift between compared LF images, as a share of their longer side, and of the angle
// between their rays to the middle of the scene.
constexpr double kMuchShift = 0.25, kMostShift = 0.5;
constexpr double kLargeAngle_deg = 8, kMostAngle_deg = 15;

// Returns the median shift between working images and those that they are compared with, per unit
// of inverse depth; only the `most` nearest of these count.
double ShiftOf(const LightField& light_field, const DensifyPlan& plan, int divisor,
               size_t most = SIZE_MAX) {
  std::vector<double> shifts;
  for (uint32_t i = 0; i < plan.compare_with.size(); ++i) {
    const PinholeCamera camera = WorkingCamera(light_field.Camera(LfImageId{i}), divisor);
    std::vector<double> of_camera;
    for (const uint32_t other : plan.compare_with[i])
      of_camera.push_back(ShiftPerInverseDepth(camera, light_field.Camera(LfImageId{other})));
    std::sort(of_camera.begin(), of_camera.end());
    of_camera.resize(std::min(most, of_camera.size()));
    shifts.push_back(std::accumulate(of_camera.begin(), of_camera.end(), 0.0) /
                     static_cast<double>(of_camera.size()));
  }
  return Median(std::move(shifts));
}

Result<void> CheckCameras(const CameraPlane& plane) {
  if (!AreOnOneLine(plane.points)) return {};
  return InputError(fmt::format(
      "the {} LF cameras stand on one line, or at one place: virtual LF images can only be made "
      "between LF cameras that surround an area",
      plane.points.size()));
}

// Checks that neighbouring LF images are near enough to one another.
Result<void> CheckReach(const LightField& light_field, const DensifyPlan& plan, int divisor,
                        bool force) {
  constexpr size_t kNearest = 3;
  const Intrinsics k = light_field.Camera(LfImageId{0}).intrinsics;
  const double shift_px = ShiftOf(light_field, plan, divisor, kNearest) * divisor;
  const double share =
      shift_px * (plan.range.greatest - plan.range.least) / std::max(k.width_px, k.height_px);
  const double middle = (plan.range.least + plan.range.greatest) / 2;
  const double angle_deg = DegreesFromRadians(std::atan(shift_px / k.fx_px * middle));
  const std::string figures = fmt::format(
      "between neighbouring LF images, near points of the scene shift by {:.0f} % of the longer "
      "side against far ones, and rays to the middle of the scene differ by {:.1f} degrees",
      100 * share, angle_deg);
  if ((share > kMostShift || angle_deg > kMostAngle_deg) && !force)
    return InputError(fmt::format(
        "{}: expected at most {:.0f} % and {:.0f} degrees; take photographs at smaller distances, "
        "or try {{force}}",
        figures, 100 * kMostShift, kMostAngle_deg));
  if (share > kMuchShift || angle_deg > kLargeAngle_deg)
    LogWarning("{}: what virtual LF images show beside outlines will often be wrong", figures);
  return {};
}

// Returns the distance between LF cameras that brings about a spacing in a frame, or in virtual LF
// images if there are no frames.
double DistanceFor(const LightField& light_field, const DensifyPlan& plan,
                   const DensifyChoices& choices) {
  const double f_px = light_field.Camera(LfImageId{0}).intrinsics.fx_px / choices.divisor;
  double least = choices.frames.empty()
                     ? choices.spacing_px / (f_px * (plan.range.greatest - plan.range.least))
                     : INFINITY;
  for (const RenderCamera& frame : choices.frames) {
    const double focus = 1 / frame.focus_distance_w;
    const double away =
        std::max(std::abs(plan.range.least - focus), std::abs(plan.range.greatest - focus));
    least = std::min(least, choices.spacing_px / (frame.pinhole.intrinsics.fx_px * away));
  }
  return least;
}

// Returns the light field of virtual LF cameras alone.
LightField VirtualField(const LightField& light_field, std::span<const VirtualCamera> cameras) {
  LightField result;
  result.encoding = light_field.encoding;
  for (const VirtualCamera& wanted : cameras) {
    LfCamera camera;
    camera.cam_from_world = wanted.camera.cam_from_world;
    camera.intrinsics_index = static_cast<uint32_t>(result.intrinsics.size());
    result.intrinsics.push_back(wanted.camera.intrinsics);
    result.cameras.push_back(camera);
    result.image_names.emplace_back();
  }
  return result;
}

// Keeps the virtual LF cameras that contribute to one of the frames.
std::vector<VirtualCamera> Contributing(const LightField& light_field,
                                        std::vector<VirtualCamera> cameras,
                                        std::span<const RenderCamera> frames, ThreadPool& pool) {
  const LightField field = VirtualField(light_field, cameras);
  SelectOptions select;
  select.reach = PixelReach::kElement;
  std::vector<uint32_t> kept;
  for (const SelectedImage& image : SelectImages(ImageIndex(field), frames, select, pool))
    kept.push_back(image.id.value);
  std::sort(kept.begin(), kept.end());
  std::vector<VirtualCamera> result;
  for (const uint32_t id : kept) result.push_back(std::move(cameras[id]));
  return result;
}

// Chooses the virtual LF cameras; if there are too many, they stand less densely.
Result<void> ChooseVirtual(const LightField& light_field, const DensifyChoices& choices,
                           ThreadPool& pool, DensifyPlan* plan) {
  constexpr double kCoarser = 1.02;
  constexpr double kMostPlaces = 400'000;  // more would take minutes
  // Beyond the LF cameras, virtual ones may only stand on a plane.
  const double outside_w = plan->plane.is_unrolled ? 0 : kOutside * MedianSpacing(light_field);
  const double wanted_w = DistanceFor(light_field, *plan, choices);
  // The mean distance of compared LF cameras; rows may be farther apart than columns.
  const double recorded_w = plan->shift_per_depth_px /
                            light_field.Camera(LfImageId{0}).intrinsics.fx_px * choices.divisor;
  if (recorded_w <= wanted_w && !choices.force) {
    plan->dense = fmt::format(
        "the LF cameras are {:.4g} apart, and {:.4g} suffices: copies of what is out of focus are "
        "{:.2g} px apart",
        recorded_w, wanted_w, choices.spacing_px * recorded_w / wanted_w);
    return {};
  }
  const auto most = static_cast<double>(choices.most_virtual);
  for (plan->distance_w = std::max(wanted_w, DistanceForPlaces(plan->plane.points, kMostPlaces));
       ;) {
    const std::vector<LatticePlace> lattice =
        LatticeAmong(plan->plane.points, plan->distance_w, outside_w);
    auto count = static_cast<double>(lattice.size());
    if (count <= most || !choices.frames.empty()) {
      plan->virtual_cameras.clear();
      for (const LatticePlace& at : lattice)
        plan->virtual_cameras.push_back(
            VirtualCameraAt(light_field, plan->plane, at, choices.divisor));
      if (!choices.frames.empty())
        plan->virtual_cameras =
            Contributing(light_field, std::move(plan->virtual_cameras), choices.frames, pool);
      count = static_cast<double>(plan->virtual_cameras.size());
      if (count <= most) break;
    }
    plan->distance_w *= std::max(kCoarser, 0.98 * std::sqrt(count / most));
  }
  plan->spacing_px = choices.spacing_px * plan->distance_w / wanted_w;
  if (plan->virtual_cameras.empty() && choices.frames.empty())
    return UsageError(fmt::format(
        "no virtual LF camera has room between the {} LF cameras, which are {:.4g} apart, if "
        "virtual ones are {:.4g} apart: ask for a smaller {{spacing}}, or raise {{most}} ({})",
        plan->plane.points.size(), recorded_w, plan->distance_w, choices.most_virtual));
  if (plan->virtual_cameras.empty())
    return UsageError(
        "no place between the LF cameras contributes to the frames: check the camera path with "
        "lfcammvminfo, or leave it out");
  return {};
}

// Returns `ids` and the LF images that these are compared with.
std::set<uint32_t> WithCompared(const std::set<uint32_t>& ids, const DensifyPlan& plan) {
  std::set<uint32_t> result = ids;
  for (const uint32_t id : ids)
    result.insert(plan.compare_with[id].begin(), plan.compare_with[id].end());
  return result;
}

}  // namespace

int PlanesFor(double shift_px) {
  return std::clamp(static_cast<int>(shift_px / kPlaneStep_px) + 2, kLeastPlanes, kMostPlanes);
}

double ToleranceFor(const InverseDepths& range, int planes, double shift_per_depth_px) {
  return std::max(kTolerance_px / shift_per_depth_px,
                  0.8 * (range.greatest - range.least) / (planes - 1));
}

Result<DensifyPlan> PlanDensify(const LightField& light_field, const LfImageStore& store,
                                const DensifyChoices& choices, ThreadPool& pool,
                                const RangeSearch& search) {
  DensifyPlan plan;
  plan.divisor = choices.divisor;
  LF_ASSIGN_OR_RETURN(plan.plane, CameraPlaneOf(light_field));
  LF_RETURN_IF_ERROR(CheckCameras(plan.plane));
  plan.compare_with = CompareWith(plan.plane.points);
  if (choices.depths) {
    plan.range = {1 / choices.depths->far_w, 1 / choices.depths->near_w};
  } else {
    LF_ASSIGN_OR_RETURN(plan.range,
                        search ? search(plan.compare_with)
                               : FindInverseDepths(light_field, store, plan.compare_with, pool));
  }
  plan.shift_per_depth_px = ShiftOf(light_field, plan, choices.divisor);
  LF_RETURN_IF_ERROR(CheckReach(light_field, plan, choices.divisor, choices.force));
  plan.planes = PlanesFor(plan.ShiftPx());
  plan.tolerance = ToleranceFor(plan.range, plan.planes, plan.shift_per_depth_px);
  LF_RETURN_IF_ERROR(ChooseVirtual(light_field, choices, pool, &plan));
  std::set<uint32_t> sources;
  for (const VirtualCamera& camera : plan.virtual_cameras)
    for (const WeightedPoint& source : camera.sources) sources.insert(source.index);
  plan.sources.assign(sources.begin(), sources.end());
  // Depths are compared with those of neighbours twice.
  const std::set<uint32_t> swept = WithCompared(WithCompared(sources, plan), plan);
  plan.swept.assign(swept.begin(), swept.end());
  return plan;
}

}  // namespace lf
