// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/gap_lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/ray_through.h"
#include "lf/core/smooth_step.h"
#include "lf/render/collect/around_lens.h"
#include "lf/selection/lens_weights/covered_region.h"
#include "lf/selection/lens_weights/image_feather.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {
namespace {

// Returns points that have the same convex hull, without most of those inside it: those within the
// polygon of the extreme points in eight directions. Quicker than sorting all points.
std::vector<Vec2> OuterPoints(std::span<const Vec2> points) {
  constexpr int kDirections = 8;
  const Vec2 directions[kDirections] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                        {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  Vec2 corners[kDirections + 1];
  for (int k = 0; k < kDirections; ++k)
    corners[k] = *std::max_element(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
      return directions[k].dot(a) < directions[k].dot(b);
    });
  corners[kDirections] = corners[0];
  std::vector<Vec2> outer(corners, corners + kDirections);
  for (const Vec2& point : points)
    for (int k = 0; k < kDirections; ++k)
      if (corners[k] != corners[k + 1] &&
          Cross(corners[k + 1] - corners[k], point - corners[k]) <= 0) {
        outer.push_back(point);
        break;
      }
  return outer;
}

// Finds the places of the lens that are not covered.
class GapFinder {
 public:
  //   near       LF cameras near the lens, sorted
  //   collected  the lens with which the frame collects rays
  GapFinder(const LightField& light_field, const RenderCamera& frame,
            std::span<const LfImageId> near, const FrameLens& collected, double camera_distance_w)
      : frame_(frame),
        plane_(frame),
        collected_(collected),
        opening_(frame.aperture),
        hat_share_(collected.weights() != nullptr ? collected.weights()->hat_share() : 0),
        has_same_places_(!frame.hood.exists() && !frame.transmission) {
    std::vector<Vec2> points;
    const Intrinsics& plate = frame.pinhole.intrinsics;
    const std::optional<Vec3> middle =
        FocusPointOfElement(frame, 0.5 * plate.width_px, 0.5 * plate.height_px);
    for (const LfImageId id : near) {
      const PinholeCamera lf_camera = light_field.Camera(id);
      cameras_.push_back({RayThrough(lf_camera, frame.pinhole.ForwardWorld()), collected.Takes(id),
                          collected.IndexOf(id)});
      if (!middle) continue;
      const Vec2 point = plane_.PointOfLine(cameras_.back().ray.centre_world(), *middle);
      if (point.allFinite()) points.push_back(point);
    }
    neighbour_distance_w_ = DistanceOfMost(points);
    const double places_w = std::sqrt(Area(frame.aperture) / GapLens::kPlaces);
    near_w_ = std::max(GapLens::kCoveredDistances * camera_distance_w, places_w);
    farthest_w_ = std::max(GapLens::kFarthestDistances * camera_distance_w, near_w_);
    edge_w_ = std::max(places_w, GapLens::kLeastEdge_distances * camera_distance_w);
    if (has_same_places_) same_places_ = OpenPlaces(frame, Vec3::Zero(), GapLens::kPlaces);
  }

  LensPart PartAt(double x_px, double y_px, const Vec3& focus_world) const {
    LensPart part;
    const std::vector<LensPlace> places =
        has_same_places_ ? same_places_ : OpenPlaces(frame_, focus_world, GapLens::kPlaces);
    double sum = 0;
    for (const LensPlace& place : places) sum += place.weight;
    if (!(sum > 0)) return part;
    const Intrinsics& plate = frame_.pinhole.intrinsics;
    const int x = std::clamp(static_cast<int>(x_px), 0, plate.width_px - 1);
    const int y = std::clamp(static_cast<int>(y_px), 0, plate.height_px - 1);
    std::vector<Vec2> seen, collected;
    seen.reserve(cameras_.size());
    collected.reserve(cameras_.size());
    part.sees.assign(cameras_.size(), false);
    for (size_t i = 0; i < cameras_.size(); ++i) {
      const NearCamera& camera = cameras_[i];
      const Vec2 through = plane_.PointOfLine(camera.ray.centre_world(), focus_world);
      if (!through.allFinite() || !IsSeenBy(camera.ray, focus_world)) continue;
      seen.push_back(through);
      part.sees[i] = true;
      if (IsCollected(camera, through, x, y)) collected.push_back(through);
    }
    if (seen.empty()) return part;
    // LF cameras on one place represent the whole lens.
    const CoveredRegion region = neighbour_distance_w_ > 0
                                     ? CoveredRegion(OuterPoints(seen), neighbour_distance_w_ / 2)
                                     : CoveredRegion();
    double missing = 0;
    for (const LensPlace& place : places) {
      const double beyond = PastEdge(region.Beyond_w(place.place));
      const double far = PastEdge(NearestOf(collected, place.place) - near_w_);
      // Hats stand for the whole lens, wherever it is.
      const double missing_part = collected.empty() ? 1 : (1 - hat_share_) * std::max(beyond, far);
      if (!(missing_part > 0) || NearestOf(seen, place.place) > farthest_w_) continue;
      const double share = place.weight / sum * missing_part;
      missing += share;
      // Natural neighbours take long. They are for places that are far from collected rays.
      const double between = far > 0 ? 1 - beyond : 0;
      if (between > 0) part.between.push_back({place.place, between * share});
      if (between < 1) part.beyond.push_back({place.place, (1 - between) * share});
    }
    const double factor = SmoothStep(missing, GapLens::kNothingMissing, GapLens::kLittleMissing);
    if (factor == 0) return {};
    part.spread_w = GapLens::kSpread_distances * neighbour_distance_w_;
    for (std::vector<LensPlace>* const of_kind : {&part.between, &part.beyond})
      for (LensPlace& place : *of_kind) place.weight *= factor;
    return part;
  }

 private:
  // An LF camera near the lens.
  struct NearCamera {
    RayThrough ray;
    bool is_taken;                // false: none of its rays is collected
    std::optional<size_t> index;  // in the weights of collected rays
  };

  bool IsCollected(const NearCamera& camera, const Vec2& through, int x, int y) const {
    if (!camera.is_taken) return false;
    if (collected_.tests_opening() && !opening_.Contains(through)) return false;
    const FrameWeights* const weights = collected_.weights();
    return weights == nullptr || (camera.index && weights->At(*camera.index, x, y) > 0);
  }

  // Returns the distance to the nearest point; infinity if there is none. Distances at which all is
  // covered are not told from each other.
  double NearestOf(const std::vector<Vec2>& points, const Vec2& place) const {
    const double surely_w = near_w_ - 0.5 * edge_w_;
    const double surely_w2 = surely_w > 0 ? surely_w * surely_w : 0;
    double nearest_w2 = std::numeric_limits<double>::infinity();
    for (const Vec2& point : points) {
      nearest_w2 = std::min(nearest_w2, (point - place).squaredNorm());
      if (nearest_w2 <= surely_w2) break;
    }
    return std::sqrt(nearest_w2);
  }

  // Rises from 0 to 1 across an edge that is passed at 0. An edge is as wide as the part of the
  // lens that a place stands for, so that frames change smoothly while a lens grows.
  double PastEdge(double distance_w) const {
    return std::clamp(0.5 + distance_w / edge_w_, 0.0, 1.0);
  }

  const RenderCamera& frame_;
  const LensPlane plane_;
  const FrameLens& collected_;
  const ApertureTest opening_;
  const double hat_share_;
  const bool has_same_places_;  // true: every element sees same_places_
  std::vector<LensPlace> same_places_;
  std::vector<NearCamera> cameras_;
  double neighbour_distance_w_;
  double near_w_;
  double farthest_w_;
  double edge_w_;
};

}  // namespace

GapLens::GapLens(const ImageIndex& index, const RenderCamera& frame, const FrameLens& collected,
                 const RankRange& ranks, const SelectOptions& select, ThreadPool& pool,
                 std::optional<double> camera_distance_w)
    : light_field_(index.light_field()), camera_(frame) {
  const double distance_w =
      camera_distance_w ? *camera_distance_w : CameraDistanceAround(index, frame);
  if (!(distance_w > 0)) return;
  RenderCamera grown = frame;
  OpenUpTo(frame.aperture.radius_w + kFarthestDistances * distance_w, &grown);
  for (const SelectedImage& image : SelectImages(index, std::span(&grown, 1), select, pool))
    if (ranks.Holds(image.rank)) near_.push_back(image.id);
  std::sort(near_.begin(), near_.end());
  if (near_.empty()) return;
  std::vector<Vec3> centres_world;
  for (const LfImageId id : near_) centres_world.push_back(light_field_.Camera(id).CentreWorld());
  const GapFinder gaps(light_field_, frame, near_, collected, distance_w);
  weights_.emplace(
      frame, centres_world,
      [&gaps](double x_px, double y_px, const Vec3& focus_world) {
        return gaps.PartAt(x_px, y_px, focus_world);
      },
      pool);
  if (!weights_->HasPart()) return;
  // The disk is slightly larger, so that rays on its border count as inside.
  OpenUpTo(weights_->reach_w() * (1 + 1e-6), &camera_);
  for (size_t i = 0; i < near_.size(); ++i)
    if (weights_->TakesPart(i) && weights_->ConstantOf(i) != 0) images_.push_back(near_[i]);
}

std::optional<size_t> GapLens::IndexOf(LfImageId id) const {
  const auto found = std::lower_bound(near_.begin(), near_.end(), id);
  if (found == near_.end() || *found != id) return std::nullopt;
  return static_cast<size_t>(found - near_.begin());
}

bool GapLens::Takes(LfImageId id) const {
  return std::binary_search(images_.begin(), images_.end(), id);
}

RenderCamera GapLens::CameraOf(LfImageId id) const {
  RenderCamera camera = camera_;
  camera.window = weights_->ElementsOf(*IndexOf(id));
  return camera;
}

RayWeights GapLens::WeightsOf(LfImageId id) const {
  if (!Takes(id)) return 0;
  const size_t camera = *IndexOf(id);
  auto feather = std::make_shared<const ImageFeather>(light_field_.Camera(id), camera_);
  return RayWeights(
      weights_->BlocksOf(camera),
      [this, camera](int end_x, int end_y, int count, uint8_t* weights) {
        weights_->OfRow(camera, end_x, end_y, count, weights);
      },
      [feather](int x, int y, int columns, int rows, uint16_t* of_corners) {
        feather->OfCorners(x, y, columns, rows, of_corners);
      },
      [feather](const PixelRect& rect) { return feather->IsWhole(rect); });
}

}  // namespace lf
