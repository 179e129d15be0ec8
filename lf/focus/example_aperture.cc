// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/example_aperture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr double kMostSpacings = 8;
constexpr double kGoodCopies_px = 3, kMostCopies_px = 16;
// An aperture of this diameter contains only the LF camera at its middle. A wider one could contain
// others, because in captures shaped like rings the hat weights of other LF cameras reach far into
// the lens.
constexpr double kSharpSpacings = 0.001;
constexpr double kShare = 0.75;      // share of the places whose copies are near enough
constexpr size_t kFewestPlaces = 8;  // fewer textured places tell nothing
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the diameter of the smallest aperture that contains kFewestCameras LF cameras which see
// the focus, at as many positions. An LF camera counts where the line from it to the focus passes
// the plane of the lens.
double SmallestBlurringLens(const LightField& light_field, const PinholeCamera& camera,
                            double focus_distance_w) {
  const Vec3 forward = camera.ForwardWorld();
  const Vec3 focus_world = camera.CentreWorld() + focus_distance_w * forward;
  std::vector<std::pair<double, uint32_t>> radii_w;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const Vec3 offset = light_field.Camera(LfImageId{i}).CentreWorld() - focus_world;
    const double depth_w = -offset.dot(forward);
    if (!(depth_w > 0)) continue;
    const Vec3 across = offset + depth_w * forward;
    radii_w.emplace_back(across.norm() * focus_distance_w / depth_w, i);
  }
  std::sort(radii_w.begin(), radii_w.end());
  constexpr double kSamePosition = 1e-6;  // as a share of the focus distance
  std::vector<Vec3> centres;              // of those that count
  for (const auto& [radius_w, i] : radii_w) {
    const PinholeCamera other = light_field.Camera(LfImageId{i});
    const bool is_counted = std::any_of(centres.begin(), centres.end(), [&](const Vec3& centre) {
      return (centre - other.CentreWorld()).norm() < kSamePosition * focus_distance_w;
    });
    if (is_counted) continue;
    const RayThrough rays(other, other.ForwardWorld());
    const auto at = rays.RecordedAt(focus_world - rays.centre_world());
    const bool is_seen = at && at->x() >= 0 && at->y() >= 0 &&
                         at->x() <= other.intrinsics.width_px &&
                         at->y() <= other.intrinsics.height_px;
    constexpr double kMargin = 1.02;  // so that the last LF camera is within the aperture
    if (is_seen) centres.push_back(other.CentreWorld());
    if (centres.size() == kFewestCameras) return 2 * kMargin * radius_w;
  }
  return kInfinity;
}

// Returns the distance between copies that kShare of `count` seen depths do not exceed; infinity if
// too many of them are unknown.
double CopiesOf(const SeenDepths& seen, size_t count, double fx_px, double spacing_w,
                double focus_w) {
  std::vector<double> copies_px;
  for (const double per_w : seen.per_w)
    copies_px.push_back(
        CopiesApart_px(fx_px, spacing_w, focus_w, per_w > 0 ? 1 / per_w : kInfinity));
  const auto at = static_cast<size_t>(kShare * static_cast<double>(count - 1));
  if (at >= copies_px.size()) return kInfinity;
  std::nth_element(copies_px.begin(), copies_px.begin() + static_cast<ptrdiff_t>(at),
                   copies_px.end());
  return copies_px[at];
}

// How far apart a lens would show copies; 0 if nothing is known.
struct Copies {
  double places_px = 0;     // of the textured places of the LF image
  double known_px = 0;      // of those alone whose depths are known
  double points_px = 0;     // of reconstructed points
  bool is_assumed = false;  // true: places_px is that of a point at an assumed depth
};

// Returns the reason why the copies are too far apart.
std::string WhyCopies(const Copies& copies, const SeenDepths& places) {
  if (copies.places_px > kMostCopies_px && copies.is_assumed)
    return fmt::format(
        "objects a quarter of the focus distance before it would appear as copies {:.0f} px apart",
        copies.places_px);
  if (std::max(copies.known_px, copies.points_px) <= kMostCopies_px)
    return fmt::format(
        "neighbouring LF images agree on a depth at only {} of {} textured places: it is not sure "
        "how wide the lens may be, because the others may appear as copies, far apart",
        places.per_w.size(), places.count);
  return fmt::format("a quarter of what is seen would appear as copies {:.0f} px apart or more",
                     std::max(copies.known_px, copies.points_px));
}

// Returns an aperture that holds one LF camera.
ExampleAperture Sharp(const std::string& why, const std::string& copies, double least_spacings) {
  return {kSharpSpacings, "which holds one LF camera, " + why, copies, least_spacings};
}

}  // namespace

ExampleAperture ChooseAperture(const LightField& light_field, const PinholeCamera& camera,
                               const ExampleFocus& focus, double spacing_w) {
  const double fx_px = camera.intrinsics.fx_px;
  const double least = SmallestBlurringLens(light_field, camera, focus.distance_w) / spacing_w;
  if (!focus.doubt.empty())
    return Sharp("so that the first frame is sharp at any distance", "", least);
  const auto copies_of = [&](const SeenDepths& seen, size_t count) {
    return count == 0 ? 0 : CopiesOf(seen, count, fx_px, spacing_w, focus.distance_w);
  };
  constexpr double kAssumedNear = 0.75;
  Copies copies;
  copies.is_assumed = focus.places.count < kFewestPlaces;
  copies.places_px = copies.is_assumed ? CopiesApart_px(fx_px, spacing_w, focus.distance_w,
                                                        kAssumedNear * focus.distance_w)
                                       : copies_of(focus.places, focus.places.count);
  copies.known_px = copies_of(focus.places, focus.places.per_w.size());
  if (focus.points.count >= kFewestPlaces)
    copies.points_px = copies_of(focus.points, focus.points.count);
  const double copies_px = std::max(copies.places_px, copies.points_px);
  if (copies_px > kMostCopies_px) {
    const std::string why = WhyCopies(copies, focus.places);
    return Sharp("because " + why, why, least);
  }
  const double widest = kWidestLens * focus.distance_w / spacing_w;
  if (std::isinf(least))
    return Sharp(fmt::format("because fewer than {} LF cameras see the focus, which would show "
                             "copies instead of a blur",
                             kFewestCameras),
                 "too few of them see the focus", least);
  if (least > widest)
    return Sharp(
        fmt::format("because the {} LF cameras that a blur needs lie {:.2g} of the focus distance "
                    "apart, and a lens wider than {:.2g} of it looks around objects",
                    kFewestCameras, least * spacing_w / focus.distance_w, kWidestLens),
        "a lens that holds enough of them to blur would look around objects", least);
  const double wished = std::clamp(kMostSpacings * kGoodCopies_px / std::max(copies_px, 1e-9),
                                   least, std::max(least, kMostSpacings));
  const double spacings = std::min(wished, widest);
  std::string reason = fmt::format(
      "{:.2g} spacings of LF cameras; {} of what is out of focus appears as copies at most {:.2g} "
      "px apart",
      spacings, copies.is_assumed ? "much" : "three quarters", copies_px);
  if (wished > widest)
    reason += fmt::format(
        "; it is limited to {:.2g} of the focus distance, because a wider lens looks around "
        "objects",
        kWidestLens);
  return {spacings, reason, "", least};
}

ExampleAperture ChooseDensifiedAperture(const LightField& light_field, const PinholeCamera& camera,
                                        const Intrinsics& frame, const ExampleFocus& focus,
                                        double spacing_w) {
  constexpr double kBlur = 0.04;  // share of the width of the picture
  constexpr double kPlaces = 0.9, kAssumedNear = 0.75;
  const ExampleAperture recorded = ChooseAperture(light_field, camera, focus, spacing_w);
  if (!focus.doubt.empty()) return recorded;
  const double focus_per_w = 1 / focus.distance_w;
  std::vector<double> away_per_w;
  for (const SeenDepths& seen : {focus.places, focus.points})
    for (const double per_w : seen.per_w) away_per_w.push_back(std::abs(per_w - focus_per_w));
  double most_per_w = (1 / kAssumedNear - 1) * focus_per_w;
  if (away_per_w.size() >= kFewestPlaces) {
    const auto at = away_per_w.begin() +
                    static_cast<ptrdiff_t>(kPlaces * static_cast<double>(away_per_w.size() - 1));
    std::nth_element(away_per_w.begin(), at, away_per_w.end());
    most_per_w = *at;
  }
  const double blurred_w = kBlur * frame.width_px / (frame.fx_px * std::max(most_per_w, 1e-9));
  const double widest_w = kWidestDensified * focus.distance_w;
  const double diameter_w = std::min({blurred_w, spacing_w, widest_w});
  if (recorded.spacings * spacing_w >= diameter_w) return recorded;
  std::string reason =
      fmt::format("filled with virtual LF images, {:.2g} of the distance between LF cameras",
                  diameter_w / spacing_w);
  if (blurred_w <= diameter_w)
    reason += fmt::format("; what is out of focus is blurred over up to {:.0f} % of the width",
                          100 * kBlur);
  return {diameter_w / spacing_w, reason, "", diameter_w / spacing_w};
}

}  // namespace lf
