// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/focus_pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"
#include "lf/camera/ray_through.h"
#include "lf/focus/depth_sweep.h"

namespace lf {
namespace {

// Half width of a patch, in elements or in LF pixels, whichever are larger.
constexpr int kHalfPatch = 5;
constexpr int kPatchSide = 2 * kHalfPatch + 1;
constexpr int kPatchSize = kPatchSide * kPatchSide;
// Step of the largest disparity from one tested depth to the next, in LF pixels.
constexpr double kStep_px = 0.5;
constexpr double kMostDisplaced = 0.45;  // largest disparity tested, in widths of the LF image
// Least standard deviation in a patch with texture, of the square root of light (ValueAt()).
constexpr double kLeastTexture = 0.004;
constexpr double kLeastAgreement = 0.6;  // least Agreement::score of a depth that is found
constexpr size_t kLeastViews = 3;        // least number of other views to compare with the first
constexpr double kAgreeing = 0.6;        // share of views that must agree on a depth
// Least cosine of the angle between the ray and the optical axis of an LF camera that is used.
constexpr double kLeastCosine = 0.5;

using Patch = std::array<float, kPatchSize>;

// An LF image that is compared.
struct View {
  LfImageId id;
  RayThrough rays;
  double offset_w = 0;  // distance of the LF camera from the ray, normal to the ray
  LfPixels pixels = {};
};

// The ray along which the depth is searched, and the axes of the patch around the ray.
struct SearchRay {
  Vec3 origin, direction, right, up;  // direction, right and up have length 1
  double angle_px = 0;                // width of a pixel of the patch, in radians

  Vec3 At(double depth_w, double x, double y) const {
    return origin + depth_w * (direction + angle_px * (x * right + y * up));
  }
};

SearchRay MakeSearchRay(const RenderCamera& frame, const Ray& ray, double lf_focal_px) {
  SearchRay search;
  search.origin = ray.origin;
  search.direction = ray.direction.normalized();
  search.right = (frame.pinhole.RightWorld() -
                  search.direction * search.direction.dot(frame.pinhole.RightWorld()))
                     .normalized();
  search.up = search.right.cross(search.direction);
  search.angle_px = std::max(1 / lf_focal_px, 1 / frame.pinhole.intrinsics.fx_px);
  return search;
}

// Returns the wanted positions of LF cameras in the plane normal to the ray: on the ray, on a ring
// of radius `radius_w` around it, and on a ring half as wide.
std::vector<Vec2> WantedPlaces(double radius_w) {
  std::vector<Vec2> places = {Vec2::Zero()};
  for (int i = 0; i < 12; ++i) {
    const bool is_outer = i < 8;
    const double angle = is_outer ? kPi / 4 * i : kPi / 2 * i + kPi / 4;
    const double distance = is_outer ? radius_w : 0.5 * radius_w;
    places.push_back({distance * std::cos(angle), distance * std::sin(angle)});
  }
  return places;
}

// Chooses the LF camera nearest to each wanted position. If fewer than nine LF cameras lie within
// the outer ring, both rings are widened. The views ascend by the distance of their LF cameras from
// the ray's origin, so that the nearest view that can be read comes first.
std::vector<View> ChooseViews(const LightField& field, const SearchRay& search, double radius_w) {
  struct Candidate {
    LfImageId id;
    Vec2 place;
    double behind_w;  // distance from the ray's origin along the ray
  };
  std::vector<Candidate> candidates;
  for (uint32_t i = 0; i < field.size(); ++i) {
    const PinholeCamera camera = field.Camera(LfImageId{i});
    if (camera.ForwardWorld().dot(search.direction) < kLeastCosine) continue;
    const Vec3 offset = camera.CentreWorld() - search.origin;
    candidates.push_back({LfImageId{i},
                          {search.right.dot(offset), search.up.dot(offset)},
                          std::abs(search.direction.dot(offset))});
  }
  const auto distance = [](const Candidate& one, const Vec2& place) {
    return (one.place - place).norm() + one.behind_w;
  };
  if (candidates.size() > 1) {
    std::vector<double> near;
    for (const Candidate& one : candidates) near.push_back(distance(one, Vec2::Zero()));
    const size_t eighth = std::min<size_t>(near.size() - 1, 8);
    std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(eighth), near.end());
    radius_w = std::max(radius_w, near[eighth]);
  }
  std::vector<View> views;
  for (const Vec2& place : WantedPlaces(radius_w)) {
    const auto nearest = std::min_element(candidates.begin(), candidates.end(),
                                          [&](const Candidate& a, const Candidate& b) {
                                            return distance(a, place) < distance(b, place);
                                          });
    if (nearest == candidates.end()) break;
    const bool is_there = std::any_of(views.begin(), views.end(),
                                      [&](const View& view) { return view.id == nearest->id; });
    if (!is_there)
      views.push_back({nearest->id, RayThrough(field.Camera(nearest->id), search.direction),
                       nearest->place.norm()});
  }
  const auto from_origin = [&](const View& view) {
    return (view.rays.centre_world() - search.origin).norm();
  };
  std::stable_sort(views.begin(), views.end(),
                   [&](const View& a, const View& b) { return from_origin(a) < from_origin(b); });
  return views;
}

// Returns the square root of the bilinearly interpolated light (mean of R, G and B) at a position,
// because noise of the square root is about equal in shadows and highlights. None if one of the
// four pixels around the position is masked or was not loaded.
std::optional<float> ValueAt(const LfPixels& pixels, const Vec2& place) {
  const double x = place.x() - 0.5 - pixels.rect.x_begin, y = place.y() - 0.5 - pixels.rect.y_begin;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  if (column < 0 || row < 0 || column + 1 >= pixels.rect.width() || row + 1 >= pixels.rect.height())
    return std::nullopt;
  const double u = x - column, v = y - row;
  const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const int at_x = column + i % 2, at_y = row + i / 2;
    if (pixels.IsMasked(at_x, at_y)) return std::nullopt;
    for (int c = 0; c < 3; ++c) sum += weights[i] * pixels.radiance.at(at_x, at_y, c);
  }
  return static_cast<float>(std::sqrt(sum / (3 * 65535.0)));
}

// Reads the patch around the point of the ray at a depth, as the view sees it, and subtracts the
// patch's mean. Returns the patch's standard deviation; none if the view does not show the whole
// patch.
std::optional<double> ReadPatch(const View& view, const SearchRay& search, double depth_w,
                                Patch* patch) {
  double sum = 0, squares = 0;
  for (int i = 0; i < kPatchSize; ++i) {
    const int column = i % kPatchSide, row = i / kPatchSide;
    const Vec3 point = search.At(depth_w, column - kHalfPatch, kHalfPatch - row);
    const std::optional<Vec2> place = view.rays.RecordedAt(point - view.rays.centre_world());
    if (!place) return std::nullopt;
    const std::optional<float> value = ValueAt(view.pixels, *place);
    if (!value) return std::nullopt;
    (*patch)[static_cast<size_t>(i)] = *value;
    sum += *value;
  }
  const auto mean = static_cast<float>(sum / kPatchSize);
  for (float& value : *patch) {
    value -= mean;
    squares += static_cast<double>(value) * value;
  }
  return std::sqrt(squares / kPatchSize);
}

struct Agreement {
  // Mean of the largest 60 % of the other views' correlations with the first view; -1 if too few
  // views show the patch.
  double score = -1;
  double texture = 0;  // standard deviation of the first view's patch
};

Agreement AgreementAt(std::span<const View> views, const SearchRay& search, double depth_w) {
  Patch reference, other;
  const std::optional<double> texture = ReadPatch(views[0], search, depth_w, &reference);
  if (!texture) return {};
  std::vector<double> correlations;
  for (const View& view : views.subspan(1)) {
    const std::optional<double> deviation = ReadPatch(view, search, depth_w, &other);
    if (!deviation) continue;
    double product = 0;
    for (int i = 0; i < kPatchSize; ++i)
      product +=
          static_cast<double>(reference[static_cast<size_t>(i)]) * other[static_cast<size_t>(i)];
    // A lower bound of the deviations keeps mere noise from correlating.
    const double scale = kPatchSize * std::max(*texture, kLeastTexture / 4) *
                         std::max(*deviation, kLeastTexture / 4);
    correlations.push_back(product / scale);
  }
  if (correlations.size() < kLeastViews) return {-1, *texture};
  const double count = std::ceil(kAgreeing * static_cast<double>(correlations.size()));
  return {MeanOfLargest(&correlations, static_cast<size_t>(count)), *texture};
}

// Returns the depths that are tested. At the nearest one, the largest disparity between the first
// view and another is kMostDisplaced; it falls by kStep_px from depth to depth.
DepthSweep MakeSweep(std::span<const View> views) {
  double baseline_w = 0;
  for (const View& view : views) baseline_w = std::max(baseline_w, view.offset_w);
  const Intrinsics& k = views[0].rays.intrinsics();
  // The largest disparity between the first view and another, in LF pixels, at the depth of one
  // world unit.
  const double px_per_w = std::max(1e-12, k.fx_px * baseline_w);
  DepthSweep sweep;
  sweep.from_per_w = kMostDisplaced * k.width_px / px_per_w;
  sweep.step_per_w = kStep_px / px_per_w;
  sweep.count = static_cast<size_t>(sweep.from_per_w / sweep.step_per_w);
  return sweep;
}

// Returns the rectangle of the view's LF image that the sweep reads.
PixelRect PartOf(const View& view, const SearchRay& search, const DepthSweep& sweep) {
  const Intrinsics& k = view.rays.intrinsics();
  PixelRect part;
  for (size_t i = 0; i < sweep.count; i += 4)
    for (const double y : {-kHalfPatch, kHalfPatch})
      for (const double x : {-kHalfPatch, kHalfPatch}) {
        const Vec3 point = search.At(sweep.Depth(static_cast<double>(i)), x, y);
        const auto place = view.rays.RecordedAt(point - view.rays.centre_world());
        if (!place || !(place->cwiseAbs().maxCoeff() < 1e6)) continue;
        const int at_x = static_cast<int>(std::floor(place->x()));
        const int at_y = static_cast<int>(std::floor(place->y()));
        part = Bounds(part, {at_x - 4, at_y - 4, at_x + 5, at_y + 5});
      }
  return Intersection(part, {0, 0, k.width_px, k.height_px});
}

// Reads the rectangle PartOf() of each view. Removes views that cannot be read, and views whose
// rectangle is empty. Errors: kOutput if the machine lacks something, such as memory; the error of
// a view, or kInput, if too few views are left.
Result<void> LoadViews(const LightField& field, const LfImageStore& store, const SearchRay& search,
                       const DepthSweep& sweep, ThreadPool& pool, std::vector<View>* views) {
  std::vector<std::optional<Error>> errors(views->size());
  pool.ForEach(views->size(), [&](size_t i) {
    View& view = (*views)[i];
    const PixelRect part = PartOf(view, search, sweep);
    if (part.empty()) return;
    auto pixels =
        LoadWithoutThrowing(store, view.id, part, field.ImagePath(view.id).string(), LfPixels());
    if (pixels)
      view.pixels = *std::move(pixels);
    else
      errors[i] = pixels.error();
  });
  std::erase_if(*views, [](const View& view) { return view.pixels.rect.empty(); });
  for (const auto& error : errors)
    if (error && error->kind == ErrorKind::kOutput) return *error;
  if (views->size() > kLeastViews) return {};
  for (const auto& error : errors)
    if (error) return *error;
  return InputError(
      "the distance of this point cannot be measured, because fewer than four LF images show it. "
      "Click on another point");
}

}  // namespace

std::optional<Ray> RayOfLfPixel(const PinholeCamera& lf_camera, double x_px, double y_px) {
  const std::optional<Vec3> ideal = IdealPosition(
      lf_camera.intrinsics, DistortionMap(lf_camera.intrinsics.distortion), x_px, y_px);
  if (!ideal) return std::nullopt;
  return Ray{lf_camera.CentreWorld(), lf_camera.cam_from_world.rotation.transpose() *
                                          (lf_camera.intrinsics.InverseMatrix() * *ideal)};
}

Result<FocusPick> FindFocus(const LightField& light_field, const LfImageStore& store,
                            const RenderCamera& frame, const Ray& ray, ThreadPool& pool) {
  const double focal_px = light_field.intrinsics.empty() ? 1 : light_field.intrinsics[0].fx_px;
  const SearchRay search = MakeSearchRay(frame, ray, focal_px);
  std::vector<View> views = ChooseViews(light_field, search, frame.aperture.radius_w);
  if (views.size() <= kLeastViews)
    return InputError(
        "the distance cannot be measured here, because fewer than four LF cameras look in this "
        "direction. Click on another point");
  const DepthSweep sweep = MakeSweep(views);
  LF_RETURN_IF_ERROR(LoadViews(light_field, store, search, sweep, pool, &views));

  std::vector<Agreement> agreements(sweep.count);
  constexpr size_t kDepthsPerTask = 16;
  pool.ForEach((sweep.count + kDepthsPerTask - 1) / kDepthsPerTask, [&](size_t task) {
    const size_t end = std::min(sweep.count, (task + 1) * kDepthsPerTask);
    for (size_t i = task * kDepthsPerTask; i < end; ++i)
      agreements[i] = AgreementAt(views, search, sweep.Depth(static_cast<double>(i)));
  });
  size_t best = 0;
  double texture = 0;
  for (size_t i = 0; i < agreements.size(); ++i) {
    texture = std::max(texture, agreements[i].texture);
    if (agreements[i].score > agreements[best].score) best = i;
  }
  if (texture < kLeastTexture || agreements.empty())
    return InputError(
        "the distance cannot be measured here, because the LF images show no texture. Click on an "
        "edge or a texture");
  const double score = agreements[best].score;
  if (score < kLeastAgreement || agreements[best].texture < kLeastTexture)
    return InputError(
        "the distance cannot be measured here, because the LF images do not agree on one. Click on "
        "an edge or a texture, away from the outlines of nearer objects");
  // The rival is the best of the other peaks. A rival that is almost as good lowers the certainty.
  constexpr size_t kPeakWidth = 4;
  std::vector<double> scores;
  for (const Agreement& agreement : agreements) scores.push_back(agreement.score);
  const double rival = PeakElsewhere(scores, best, best, kPeakWidth, 0);
  const double place = VertexAround(scores, best, [](double at) { return at >= 0; });
  FocusPick pick;
  pick.point_world = search.At(sweep.Depth(place), 0, 0);
  pick.certainty = std::clamp((score - kLeastAgreement) / (0.95 - kLeastAgreement), 0.0, 1.0) *
                   std::clamp((score - rival) / 0.15, 0.0, 1.0);
  for (const View& view : views) pick.images.push_back(view.id);
  return pick;
}

double FocusDistanceThrough(const RenderCamera& frame, const Vec3& point_world) {
  const Vec3 offset = point_world - frame.pinhole.CentreWorld();
  return frame.pinhole.ForwardWorld().dot(offset) -
         frame.pinhole.RightWorld().dot(offset) * std::tan(frame.focus_tilt.horizontal_rad) -
         frame.pinhole.UpWorld().dot(offset) * std::tan(frame.focus_tilt.vertical_rad);
}

}  // namespace lf
