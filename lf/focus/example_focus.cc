// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/example_focus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/core/log.h"
#include "lf/focus/find_subject.h"
#include "lf/focus/point_subject.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr size_t kFewPlaces = 8;  // fewer textured places, or agreeing ones, say little

// Returns true if the depths that were found in the pixels are better than any guess, although none
// of them is sure to be the subject's.
bool IsFair(const Subject& subject) {
  constexpr double kFairShare = 0.4;
  return subject.place_count >= kFewPlaces &&
         static_cast<double>(subject.place_count) >=
             kFairShare * static_cast<double>(subject.textured_count);
}

// Returns the focus if no depth is sure: at the first depth that was found in the pixels, if these
// are fair; at the first depth of the points of a reconstruction; in the middle of the depth range;
// where the optical axes meet, which says where the photographer stood rather than what was
// photographed; or at a depth that few LF images agree on.
ExampleFocus GuessFocus(const LightField& light_field, const PinholeCamera& camera,
                        double spacing_w, const Subject& subject, const Subject& points) {
  if (IsFair(subject) && !subject.depths.empty()) {
    const SubjectDepth& best = subject.depths[0];
    return {best.distance_w, fmt::format("where {} of {} places of the image lie", best.place_count,
                                         subject.place_count)};
  }
  if (!points.depths.empty() && points.place_count >= kFewPlaces) {
    const SubjectDepth& best = points.depths[0];
    return {best.distance_w, fmt::format("where {} of {} reconstructed points lie",
                                         best.place_count, points.place_count)};
  }
  if (const std::optional<DepthRange>& range = light_field.depth_range)
    return {2 / (1 / range->near_w + 1 / range->far_w), "the middle of the depth range"};
  if (const std::optional<Vec3> point = AxesMeetingPoint(light_field)) {
    const double depth_w = camera.ForwardWorld().dot(*point - camera.CentreWorld());
    if (depth_w > spacing_w) return {depth_w, "where the optical axes meet"};
  }
  if (!subject.depths.empty())
    return {subject.depths[0].distance_w, "where some LF images agree on a depth"};
  return {camera.intrinsics.fx_px * spacing_w,
          "where the disparity between neighbouring LF cameras is one pixel"};
}

// Returns the reason why the depths that were found in the pixels, and those of the points, do not
// tell the subject.
std::string WhyNotSure(const Subject& subject, const Subject& points) {
  std::string why;
  if (points.place_count > 0)
    why = fmt::format(
        ", and {} of the {} reconstructed points that the LF image shows lie at one "
        "depth",
        points.depths[0].place_count, points.place_count);
  if (subject.textured_count == 0) return "the LF image has no texture" + why;
  const std::string agreeing =
      fmt::format("the neighbouring LF images agree on a depth at {} of {} textured places",
                  subject.place_count, subject.textured_count);
  if (!IsFair(subject) || subject.depths.empty()) return agreeing + why;
  if (subject.share_before > kMostBefore)
    return fmt::format("{}, but {:.0f} % of the picture lies before the depth of most places{}",
                       agreeing, 100 * subject.share_before, why);
  return fmt::format(
      "{}, but the depths are spread: four fifths lie from {:.4g} to {:.4g}, and only {} near "
      "{:.4g}"
      "{}",
      agreeing, subject.near_w, subject.far_w, subject.depths[0].place_count,
      subject.depths[0].distance_w, why);
}

// Returns the focus at the subject's best depth, subject.depths[0].
//   things  word for what lies at this depth, for the reason: "places of the image"
ExampleFocus FocusOf(const Subject& subject, const char* things) {
  const SubjectDepth& best = subject.depths[0];
  ExampleFocus focus{best.distance_w, fmt::format("where {} of {} {} lie", best.place_count,
                                                  subject.place_count, things)};
  focus.near_w = std::min(subject.near_w, best.distance_w);
  focus.far_w = std::max(subject.far_w, best.distance_w);
  return focus;
}

// Returns at most kMost focus distances to try: the guess, then the depths found in the pixels,
// then the depths of the points. Leaves out a distance within 3 % of a distance already listed.
std::vector<double> CandidatesOf(const Subject& subject, const Subject& points, double guess_w) {
  constexpr size_t kMost = 3;
  constexpr double kSame = 0.03;  // distances that differ by a smaller share count as one
  std::vector<double> candidates_w;
  const auto add = [&](double distance_w) {
    const bool is_new = std::none_of(candidates_w.begin(), candidates_w.end(), [&](double other) {
      return std::abs(other - distance_w) < kSame * distance_w;
    });
    if (is_new && candidates_w.size() < kMost) candidates_w.push_back(distance_w);
  };
  add(guess_w);
  for (const SubjectDepth& depth : subject.depths) add(depth.distance_w);
  for (const SubjectDepth& depth : points.depths) add(depth.distance_w);
  return candidates_w;
}

}  // namespace

Result<ExampleFocus> ChooseFocus(const LightField& light_field, const LfImageStore& store,
                                 const ExampleOptions& options, double spacing_w,
                                 ThreadPool& pool) {
  Result<Subject> found = FindSubject(light_field, store, options.camera, pool);
  if (options.focus_distance_w) {
    ExampleFocus focus{*options.focus_distance_w, "as given"};
    if (!found && found.error().kind != ErrorKind::kInput) return found.error();
    if (found) focus.places = {found->per_w, found->per_w.size() + found->disagreeing_count};
    return focus;
  }
  if (!found) return found.error();
  Subject& subject = *found;
  const auto is_outside = [&](const SubjectDepth& depth) {
    constexpr double kMargin = 1.2;
    const std::optional<DepthRange>& range = light_field.depth_range;
    return range && (depth.distance_w < range->near_w / kMargin ||
                     depth.distance_w > range->far_w * kMargin);
  };
  const auto is_sure = [&](const Subject& one) {
    return options.doubt.empty() && one.is_sure && !is_outside(one.depths[0]);
  };
  const PinholeCamera camera = light_field.Camera(options.camera);
  Subject points;
  bool is_contradicted = false;
  if (options.points_world) {
    LF_ASSIGN_OR_RETURN(const std::vector<Vec3> points_world, options.points_world());
    points = FindPointSubject(camera, points_world);
    is_contradicted =
        is_sure(subject) && PointsContradict(camera, points_world, subject.depths[0].distance_w);
  }
  const SeenDepths places = {subject.per_w, subject.per_w.size() + subject.disagreeing_count};
  if (is_sure(subject) && !is_contradicted) {
    ExampleFocus focus = FocusOf(subject, "places of the image");
    focus.places = places;
    return focus;
  }
  std::string why = WhyNotSure(subject, is_sure(points) ? Subject() : points);
  if (!options.doubt.empty())
    why = options.doubt;
  else if (is_contradicted)
    why = fmt::format(
        "the LF images agree on the distance {:.4g}, but almost none of the {} reconstructed "
        "points that the LF image at the start of the path shows lie there",
        subject.depths[0].distance_w, points.place_count);
  else if (subject.is_sure)
    why = fmt::format(
        "the LF images agree on the distance {:.4g}, which is outside the depths of the scene, "
        "{:.4g} to {:.4g}",
        subject.depths[0].distance_w, light_field.depth_range->near_w,
        light_field.depth_range->far_w);
  if (is_sure(points)) {
    ExampleFocus focus = FocusOf(points, "points of the reconstruction");
    focus.places = places;
    focus.points = {points.per_w, points.place_count};
    LogInfo("focused at {:.4g} by the points of the reconstruction, because {}", focus.distance_w,
            why);
    return focus;
  }
  std::erase_if(subject.depths, is_outside);
  ExampleFocus focus = GuessFocus(light_field, camera, spacing_w, subject, points);
  focus.doubt = why;
  focus.candidates_w = CandidatesOf(subject, points, focus.distance_w);
  return focus;
}

}  // namespace lf
