// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/gap_lens.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "lf/camera/aperture.h"
#include "lf/camera/ray_through.h"
#include "lf/render/collect/around_lens.h"
#include "lf/selection/lens_weights/image_feather.h"

namespace lf {
namespace {

// An LF camera near the lens.
struct NearCamera {
  RayThrough ray;
  RayWeights collected;  // weights of the rays that are collected; none: the LF image is not
};

// Finds the places of the lens that are not covered.
class GapFinder {
 public:
  GapFinder(const RenderCamera& frame, std::vector<NearCamera> cameras, bool tests_opening,
            double camera_distance_w)
      : frame_(frame),
        cameras_(std::move(cameras)),
        opening_(frame.aperture),
        tests_opening_(tests_opening) {
    const double places_w = std::sqrt(Area(frame.aperture) / GapLens::kPlaces);
    near_w_ = std::max(GapLens::kCoveredDistances * camera_distance_w, places_w);
    farthest_w_ = std::max(GapLens::kFarthestDistances * camera_distance_w, near_w_);
  }

  LensPart PartAt(double x_px, double y_px, const Vec3& focus_world) const {
    LensPart part;
    std::vector<LensPlace>& places = part.places;
    places = OpenPlaces(frame_, focus_world, GapLens::kPlaces);
    double sum = 0;
    for (const LensPlace& place : places) sum += place.weight;
    if (!(sum > 0)) return part;
    const Intrinsics& plate = frame_.pinhole.intrinsics;
    const int x = std::clamp(static_cast<int>(x_px), 0, plate.width_px - 1);
    const int y = std::clamp(static_cast<int>(y_px), 0, plate.height_px - 1);
    std::vector<Vec2> seen, collected;
    part.sees.assign(cameras_.size(), false);
    for (size_t i = 0; i < cameras_.size(); ++i) {
      const NearCamera& camera = cameras_[i];
      const Vec2 through = LensPointOfLine(frame_, camera.ray.centre_world(), focus_world);
      if (!through.allFinite() || !IsSeenBy(camera.ray, focus_world)) continue;
      seen.push_back(through);
      part.sees[i] = true;
      const bool is_collected = !camera.collected.are_none() &&
                                (!tests_opening_ || opening_.Contains(through)) &&
                                camera.collected.At(x, y) > 0;
      if (is_collected) collected.push_back(through);
    }
    const auto is_within = [](const std::vector<Vec2>& points, const Vec2& place, double reach_w) {
      return std::any_of(points.begin(), points.end(), [&](const Vec2& point) {
        return (point - place).squaredNorm() <= reach_w * reach_w;
      });
    };
    double missing = 0;
    std::erase_if(places, [&](LensPlace& place) {
      if (is_within(collected, place.place, near_w_)) return true;
      if (!is_within(seen, place.place, farthest_w_)) return true;
      place.weight /= sum;
      missing += place.weight;
      return false;
    });
    if (missing <= GapLens::kLittleMissing) places.clear();
    return part;
  }

 private:
  const RenderCamera& frame_;
  const std::vector<NearCamera> cameras_;
  const ApertureTest opening_;
  const bool tests_opening_;
  double near_w_;
  double farthest_w_;
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
  std::vector<NearCamera> cameras;
  for (const LfImageId id : near_) {
    const PinholeCamera lf_camera = light_field_.Camera(id);
    centres_world.push_back(lf_camera.CentreWorld());
    cameras.push_back(
        {RayThrough(lf_camera, frame.pinhole.ForwardWorld()), collected.WeightsOf(id)});
  }
  const GapFinder gaps(frame, std::move(cameras), collected.tests_opening(), distance_w);
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
