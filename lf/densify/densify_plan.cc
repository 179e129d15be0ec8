// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "lf/core/log.h"
#include "lf/core/median.h"
#include "lf/densify/camera_chart.h"
#include "lf/densify/camera_lattice.h"
#include "lf/densify/camera_plane.h"
#include "lf/densify/depth_search.h"
#include "lf/densify/film_blur.h"
#include "lf/densify/lens_places.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/working_image.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {
namespace {

constexpr int kLeastPlanes = 24, kMostPlanes = 256;
constexpr double kPlaneStep_px = 0.35;
constexpr double kTolerance_px = 0.6;
constexpr double kOutside = 0.5;  // share of the median distance between LF cameras that are used

// Limits of the shift between compared LF images, as a share of their longer side, and of the angle
// between their rays to the middle of the scene.
// Films, whose lenses lie near LF cameras, allow more.
constexpr double kMuchShift = 0.25, kMostShift = 0.5, kMostShiftOfFilm = 0.8;
constexpr double kLargeAngle_deg = 8, kMostAngle_deg = 15, kMostAngleOfFilm_deg = 20;

// Returns the median shift between working images and those that they are compared with, per unit
// of inverse depth; only the `most` nearest of these count.
double ShiftOf(const LightField& light_field, const DensifyPlan& plan, int divisor,
               size_t most = SIZE_MAX) {
  std::vector<double> shifts;
  for (const uint32_t i : plan.used) {
    const PinholeCamera camera = WorkingCamera(light_field.Camera(LfImageId{i}), divisor);
    std::vector<double> of_camera;
    for (const uint32_t other : plan.compare_with[i])
      of_camera.push_back(ShiftPerInverseDepth(camera, light_field.Camera(LfImageId{other})));
    if (of_camera.empty()) continue;
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
      "the {} LF cameras stand on one line, or at one place, and surround no area that could be "
      "filled: give the camera path of a film, so that virtual LF images are made for its lenses",
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
  const double most_share = plan.is_film ? kMostShiftOfFilm : kMostShift;
  const double most_deg = plan.is_film ? kMostAngleOfFilm_deg : kMostAngle_deg;
  if ((share > most_share || angle_deg > most_deg) && !force)
    return InputError(fmt::format(
        "{}: expected at most {:.0f} % and {:.0f} degrees; take photographs at smaller distances, "
        "or try {{force}}",
        figures, 100 * most_share, most_deg));
  if (share > kMuchShift || angle_deg > kLargeAngle_deg)
    LogWarning("{}: what virtual LF images show beside outlines will often be wrong", figures);
  return {};
}

// Returns the distance between LF cameras at which copies of points at the ends of the scene have
// the wanted spacing, in a frame, or in virtual LF images if there are no frames.
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

// Returns the distance between virtual LF cameras in the lenses of a film. A capture around an
// object has depths that no frame shows, so that points in the frames count, unless the user has
// stated the depths.
Result<double> DistanceInLenses(const LightField& light_field, const LfImageStore& store,
                                const DensifyPlan& plan, const DensifyChoices& choices,
                                ThreadPool& pool, const Watch& watch) {
  constexpr double kLeastAcross = 4;  // virtual LF cameras across a lens
  const double for_scene_w = DistanceFor(light_field, plan, choices);
  if (choices.depths) return for_scene_w;
  LF_ASSIGN_OR_RETURN(
      const std::vector<std::vector<Vec3>> points,
      FindSurePoints(light_field, store, plan.compare_with, plan.serving, pool, watch));
  const std::optional<double> copies = CopiesPerDistance(choices.frames, points);
  if (!copies) return for_scene_w;
  double most_w = INFINITY;
  for (const RenderCamera& frame : choices.frames)
    most_w = std::min(most_w, 2 * frame.aperture.radius_w / kLeastAcross);
  return std::max(for_scene_w, std::min(most_w, choices.spacing_px / *copies));
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

// Makes the lattice coarser until there are at most as many virtual LF cameras as allowed.
//   cameras_at  returns those of a lattice with a distance
template <class CamerasAt>
void ChooseDistance(double distance_w, size_t most, const CamerasAt& cameras_at,
                    DensifyPlan* plan) {
  constexpr double kCoarser = 1.02;
  for (plan->distance_w = distance_w;; plan->distance_w *= kCoarser) {
    const std::optional<size_t> count = cameras_at(plan->distance_w);
    if (!count) return;
    plan->distance_w *= std::max(
        1.0, 0.98 / kCoarser * std::sqrt(static_cast<double>(*count) / static_cast<double>(most)));
  }
}

constexpr double kMostPlaces = 400'000;  // more would take minutes

// Puts virtual LF cameras among the recorded ones.
Result<void> FillCapture(const LightField& light_field, const DensifyChoices& choices,
                         double wanted_w, DensifyPlan* plan) {
  const Result<CameraPlane> found = CameraPlaneOf(light_field);
  if (!found)
    return Error{found.error().kind, found.error().message +
                                         "; or give the camera path of a film, whose lenses are "
                                         "then filled"};
  const CameraPlane& plane = *found;
  LF_RETURN_IF_ERROR(CheckCameras(plane));
  // Beyond the LF cameras, virtual ones may only stand on a plane.
  const double outside_w = plane.is_unrolled ? 0 : kOutside * MedianSpacing(light_field);
  ChooseDistance(
      std::max(wanted_w, DistanceForPlaces(plane.points, kMostPlaces)), choices.most_virtual,
      [&](double distance_w) -> std::optional<size_t> {
        const std::vector<LatticePlace> lattice = LatticeAmong(plane.points, distance_w, outside_w);
        if (lattice.size() > choices.most_virtual) return lattice.size();
        for (const LatticePlace& at : lattice)
          plan->virtual_cameras.push_back(VirtualCameraAt(light_field, plane, at, choices.divisor));
        return std::nullopt;
      },
      plan);
  return {};
}

// Puts virtual LF cameras into the lenses of the film.
void FillLenses(const LightField& light_field, const DensifyChoices& choices,
                const FilmLenses& lenses, double wanted_w, ThreadPool& pool, DensifyPlan* plan) {
  LightField used = light_field;
  KeepImages(std::vector<size_t>(plan->used.begin(), plan->used.end()), &used);
  const double outside_w = kOutside * MedianSpacing(used);
  ChooseDistance(
      std::max(wanted_w, std::sqrt(lenses.Area_w2() / kMostPlaces)), choices.most_virtual,
      [&](double distance_w) -> std::optional<size_t> {
        const LensPlaces found = lenses.Places(distance_w, outside_w);
        plan->filled_radius_w = found.filled_radius_w;
        // Some of them may contribute nothing.
        if (found.places.size() > 2 * choices.most_virtual) return found.places.size();
        plan->virtual_cameras.clear();
        for (const LensPlace& place : found.places)
          plan->virtual_cameras.push_back(lenses.CameraAt(place, distance_w, choices.divisor));
        plan->virtual_cameras =
            Contributing(light_field, std::move(plan->virtual_cameras), choices.frames, pool);
        if (plan->virtual_cameras.size() > choices.most_virtual)
          return plan->virtual_cameras.size();
        return std::nullopt;
      },
      plan);
}

// Chooses the virtual LF cameras; if there are too many, they stand less densely.
//   lenses  of the film; null: there is no film
Result<void> ChooseVirtual(const LightField& light_field, const LfImageStore& store,
                           const DensifyChoices& choices, const FilmLenses* lenses,
                           ThreadPool& pool, const Watch& watch, DensifyPlan* plan) {
  double wanted_w = DistanceFor(light_field, *plan, choices);
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
  if (lenses) {
    LF_ASSIGN_OR_RETURN(wanted_w,
                        DistanceInLenses(light_field, store, *plan, choices, pool, watch));
    FillLenses(light_field, choices, *lenses, wanted_w, pool, plan);
  } else {
    LF_RETURN_IF_ERROR(FillCapture(light_field, choices, wanted_w, plan));
  }
  plan->spacing_px = choices.spacing_px * plan->distance_w / wanted_w;
  const bool has_places = !lenses || std::isinf(plan->filled_radius_w);
  if (plan->virtual_cameras.empty() && has_places)
    return UsageError(fmt::format(
        "no virtual LF camera has room between the {} LF cameras, which are {:.4g} apart, if "
        "virtual ones are {:.4g} apart: ask for a smaller {{spacing}}, or raise {{most}} ({})",
        light_field.size(), recorded_w, plan->distance_w, choices.most_virtual));
  if (plan->virtual_cameras.empty())
    return UsageError(
        "no virtual LF camera in the lenses of the frames has LF cameras around it: check the "
        "camera path with lfcammvminfo, or leave it out");
  return {};
}

// Returns `ids` and the LF images that these are compared with.
std::set<uint32_t> WithCompared(const std::set<uint32_t>& ids, const DensifyPlan& plan) {
  std::set<uint32_t> result = ids;
  for (const uint32_t id : ids)
    result.insert(plan.compare_with[id].begin(), plan.compare_with[id].end());
  return result;
}

// Finds the LF images that the virtual ones need.
void FindSources(DensifyPlan* plan) {
  std::set<uint32_t> sources;
  for (const VirtualCamera& camera : plan->virtual_cameras)
    for (const WeightedPoint& source : camera.sources) sources.insert(source.index);
  plan->sources.assign(sources.begin(), sources.end());
  plan->stored.clear();
  std::set_union(plan->sources.begin(), plan->sources.end(), plan->shown.begin(), plan->shown.end(),
                 std::back_inserter(plan->stored));
  // Depths are compared with those of neighbours twice. A film's second comparison does with the
  // neighbours that were compared once.
  std::set<uint32_t> swept = WithCompared(sources, *plan);
  if (!plan->is_film) swept = WithCompared(swept, *plan);
  swept.insert(plan->shown.begin(), plan->shown.end());
  plan->swept.assign(swept.begin(), swept.end());
}

}  // namespace

Result<void> CheckKind(const LightField& light_field) {
  if (HasVirtual(light_field))
    return UsageError(
        "the light field has virtual LF images already: densify the light field that was recorded");
  if (light_field.encoding.masks_clipped)
    return InputError(
        "the light field has brackets (\"lf_clipped\": \"mask\"), which are not supported: densify "
        "the LF images of one exposure");
  return {};
}

bool IsWidened(const DensifyPlan& plan) {
  return std::any_of(plan.virtual_cameras.begin(), plan.virtual_cameras.end(),
                     [](const VirtualCamera& camera) { return camera.is_beyond; });
}

void DropBeyond(std::span<const RenderCamera> frames, DensifyPlan* plan) {
  for (const VirtualCamera& camera : plan->virtual_cameras)
    for (const RenderCamera& frame : frames) {
      const double away_w = (camera.camera.CentreWorld() - frame.pinhole.CentreWorld()).norm();
      if (camera.is_beyond && away_w <= frame.aperture.radius_w)
        plan->filled_radius_w = std::min(plan->filled_radius_w, away_w);
    }
  std::erase_if(plan->virtual_cameras,
                [](const VirtualCamera& camera) { return camera.is_beyond; });
  FindSources(plan);
}

int PlanesFor(double shift_px) {
  return std::clamp(static_cast<int>(shift_px / kPlaneStep_px) + 2, kLeastPlanes, kMostPlanes);
}

double ToleranceFor(const InverseDepths& range, int planes, double shift_per_depth_px) {
  return std::max(kTolerance_px / shift_per_depth_px,
                  0.8 * (range.greatest - range.least) / (planes - 1));
}

Result<DensifyPlan> PlanDensify(const LightField& light_field, const LfImageStore& store,
                                const DensifyChoices& choices, ThreadPool& pool,
                                const RangeSearch& search, const Watch& watch) {
  DensifyPlan plan;
  plan.is_film = !choices.frames.empty();
  plan.divisor = choices.divisor;
  plan.subject = AxesMeetingPoint(light_field);
  // Without a film, the lenses in which LF images are shown are unknown.
  plan.used = FarEnoughApart(light_field, plan.is_film ? plan.subject : std::nullopt);
  plan.compare_with = CompareWith(light_field, plan.used, plan.subject);
  if (std::all_of(plan.compare_with.begin(), plan.compare_with.end(),
                  [](const auto& others) { return others.empty(); }))
    return InputError(fmt::format(
        "all {} LF cameras are at one place: virtual LF images can only be made between LF cameras "
        "at several places",
        light_field.size()));
  std::optional<FilmLenses> lenses;
  if (plan.is_film) lenses.emplace(light_field, plan.used, choices.frames);
  plan.serving = lenses ? lenses->Serving() : plan.used;
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
  LF_RETURN_IF_ERROR(
      ChooseVirtual(light_field, store, choices, lenses ? &*lenses : nullptr, pool, watch, &plan));
  if (lenses) plan.shown = lenses->Recorded(plan.distance_w);
  FindSources(&plan);
  return plan;
}

}  // namespace lf
