// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/lens_gaps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "lf/camera/ray_through.h"
#include "lf/render/collect/around_lens.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {
namespace {

constexpr int kLeastNodes = 17, kMostNodes = 65;
constexpr size_t kMostNodeValues = size_t{1} << 17;  // limit of the product nodes x lens points

}  // namespace

LensGaps::LensGaps(const ImageIndex& index, const RenderCamera& frame,
                   const CollectedWeights& collected, bool lens_test, const RankRange& ranks,
                   const SelectOptions& select, const QueryOptions& options, ThreadPool& pool,
                   std::optional<double> camera_distance_w)
    : is_collected_(static_cast<bool>(collected)) {
  all_.camera = frame;
  const double distance_w =
      camera_distance_w ? *camera_distance_w : CameraDistanceAround(index, frame);
  if (!(distance_w > 0)) return;
  std::vector<SelectedImage> images = ImagesNearLens(index, frame, distance_w, select, pool);
  std::erase_if(images, [&ranks](const SelectedImage& image) { return !ranks.Holds(image.rank); });
  sampling_ = SamplingOf(index, frame, images, distance_w);
  if (!can_be_asked()) return;
  all_ = QueriesOf(frame, sampling_, options, SeenThrough(index, frame, images));
  if (is_collected_) {
    std::vector<LfImageId> near;
    for (const SelectedImage& image : images) near.push_back(image.id);
    SetNodes(near, index);
    FindGaps(near, index, collected, lens_test, pool);
  }
  asks_in_the_end_ = AsksAt(kInTheEnd);
}

// Chooses the numbers of columns and rows of nodes, from kLeastNodes to kMostNodes. From one node
// to the next, the point where an LF camera's ray through the node's focus point meets the lens
// plane shall move by at most half of the distance up to which a ray covers a lens point
// (kCoveredDistances). The grid is made coarser if nodes times lens points would exceed
// kMostNodeValues.
void LensGaps::SetNodes(const std::vector<LfImageId>& near, const ImageIndex& index) {
  constexpr size_t kAsked = 64;
  const RenderCamera& frame = all_.camera;
  const Intrinsics& plate = frame.pinhole.intrinsics;
  double across_w = 0, down_w = 0;
  const auto seen_at = [&](const Vec3& centre, double x, double y) -> std::optional<Vec2> {
    const std::optional<Vec3> focus = FocusPointOfElement(frame, x, y);
    if (!focus) return {};
    const Vec2 point = LensPointOfLine(frame, centre, *focus);
    return point.allFinite() ? std::optional(point) : std::nullopt;
  };
  for (size_t i = 0; i < near.size(); i += 1 + near.size() / kAsked) {
    const Vec3 centre = index.light_field().Camera(near[i]).CentreWorld();
    const auto middle = seen_at(centre, 0.5 * plate.width_px, 0.5 * plate.height_px);
    const auto right = seen_at(centre, plate.width_px, 0.5 * plate.height_px);
    const auto below = seen_at(centre, 0.5 * plate.width_px, plate.height_px);
    if (middle && right) across_w = std::max(across_w, 2 * (*right - *middle).norm());
    if (middle && below) down_w = std::max(down_w, 2 * (*below - *middle).norm());
  }
  const double step_w = 0.5 * kCoveredDistances * sampling_.lf.camera_distance_w;
  const auto nodes = [step_w](double moves_w) {
    return static_cast<int>(
        std::clamp(std::ceil(moves_w / step_w) + 1, 0.0 + kLeastNodes, 0.0 + kMostNodes));
  };
  int columns = nodes(across_w), rows = nodes(down_w);
  const size_t points = all_.points.point_count();
  while (static_cast<size_t>(columns) * rows * points > kMostNodeValues &&
         columns * rows > kLeastNodes * kLeastNodes) {
    columns = std::max(columns * 7 / 8, kLeastNodes);
    rows = std::max(rows * 7 / 8, kLeastNodes);
  }
  columns_ = NodeAxis(plate.width_px, columns);
  rows_ = NodeAxis(plate.height_px, rows);
}

void LensGaps::FindGaps(const std::vector<LfImageId>& near, const ImageIndex& index,
                        const CollectedWeights& collected, bool lens_test, ThreadPool& pool) {
  const RenderCamera& frame = all_.camera;
  const ApertureTest aperture(frame.aperture);
  std::vector<Vec2> points;
  for (const auto& set : all_.points.sets) points.insert(points.end(), set.begin(), set.end());
  const double distance_w = sampling_.lf.camera_distance_w;
  const double near_w =
      std::max(kCoveredDistances * distance_w,
               std::sqrt(Area(frame.aperture) / static_cast<double>(points.size())));
  // Squared reach of each lens point of all sets. An LF camera can cover the point, or have rays
  // for the point's kernel, only if its line to the focus point meets the lens plane within this
  // reach.
  std::vector<double> reach2_w2;
  for (size_t set = 0; set < all_.points.sets.size(); ++set)
    for (size_t i = 0; i < all_.points.sets[set].size(); ++i) {
      const double reach_w =
          std::max(near_w, kReach_sigmas * all_.kernel.sigma_st_w * all_.points.SpreadOf(set, i));
      reach2_w2.push_back(reach_w * reach_w);
    }
  struct Camera {
    RayThrough ray;
    RayWeights weights;
    uint32_t rank;
    std::atomic<bool>* is_collected;
  };
  const auto collected_ones = std::make_unique<std::atomic<bool>[]>(near.size());
  std::vector<Camera> cameras;
  for (const LfImageId id : near) {
    RayWeights weights = collected(id);
    cameras.push_back({RayThrough(index.light_field().Camera(id), frame.pinhole.ForwardWorld()),
                       std::move(weights), index.RankOf(id), &collected_ones[cameras.size()]});
  }
  covered_from_.assign(node_count() * points.size(), 0);
  pool.ForEach(node_count(), [&](size_t node) {
    const double x = columns_.node_px(static_cast<int>(node % columns_.count()));
    const double y = rows_.node_px(static_cast<int>(node / columns_.count()));
    const std::optional<Vec3> focus = FocusPointOfElement(frame, x, y);
    if (!focus) return;
    uint32_t* const covered_from = covered_from_.data() + node * points.size();
    for (const Camera& camera : cameras) {
      const Vec2 through = LensPointOfLine(frame, camera.ray.centre_world(), *focus);
      if (!through.allFinite() || !IsSeenBy(camera.ray, *focus)) continue;
      const bool is_collected = (!lens_test || aperture.Contains(through)) &&
                                !camera.weights.are_none() &&
                                camera.weights.At(static_cast<int>(x), static_cast<int>(y)) > 0;
      if (is_collected) camera.is_collected->store(true, std::memory_order_relaxed);
      for (size_t i = 0; i < points.size(); ++i) {
        const double distance2_w2 = (points[i] - through).squaredNorm();
        if (distance2_w2 > reach2_w2[i]) continue;
        if (covered_from[i] == 0) covered_from[i] = UINT32_MAX;
        if (is_collected && distance2_w2 <= near_w * near_w)
          covered_from[i] = std::min(covered_from[i], camera.rank + 1);
      }
    }
  });
  for (const Camera& camera : cameras)
    if (*camera.is_collected) collected_ranks_.push_back(camera.rank);
  std::sort(collected_ranks_.begin(), collected_ranks_.end());
  for (const uint32_t from : covered_from_)
    if (from != UINT32_MAX) changes_until_ = std::max(changes_until_, from);
}

uint32_t LensGaps::RankAfter(size_t count) const {
  count = std::min(count, collected_ranks_.size());
  return count == 0 ? 0 : collected_ranks_[count - 1] + 1;
}

bool LensGaps::NodeAsksAt(size_t node, uint32_t rank) const {
  const size_t points = all_.points.point_count();
  const auto begin = covered_from_.begin() + static_cast<std::ptrdiff_t>(node * points);
  const auto missing = std::count_if(begin, begin + static_cast<std::ptrdiff_t>(points),
                                     [rank](uint32_t from) { return from > rank; });
  return static_cast<double>(missing) > kLittleMissing * static_cast<double>(points);
}

FrameQueries LensGaps::QueriesAt(uint32_t rank) const {
  FrameQueries queries = all_;
  if (!is_collected_ || !can_be_asked()) return queries;
  const size_t points = all_.points.point_count();
  queries.shares = PointShares{columns_, rows_, points, {}};
  queries.shares->values.assign(covered_from_.size(), 0);
  for (size_t node = 0; node < node_count(); ++node) {
    if (!NodeAsksAt(node, rank)) continue;
    for (size_t i = node * points; i < (node + 1) * points; ++i)
      queries.shares->values[i] = covered_from_[i] > rank ? 1 : 0;
  }
  return queries;
}

bool LensGaps::AsksAt(uint32_t rank) const {
  if (!can_be_asked()) return false;
  if (!is_collected_) return true;
  for (size_t node = 0; node < node_count(); ++node)
    if (NodeAsksAt(node, rank)) return true;
  return false;
}

RenderCamera LensGaps::ReachedCamera() const {
  RenderCamera camera = all_.camera;
  const FrameReach reach = ReachOf(all_.kernel, all_.points);
  OpenUpTo(camera.aperture.radius_w + reach.lens_w, &camera);
  const int margin_px = static_cast<int>(std::ceil(reach.plate_px));
  Intrinsics& plate = camera.pinhole.intrinsics;
  plate.width_px += 2 * margin_px;
  plate.height_px += 2 * margin_px;
  plate.cx_px += margin_px;
  plate.cy_px += margin_px;
  return camera;
}

}  // namespace lf
