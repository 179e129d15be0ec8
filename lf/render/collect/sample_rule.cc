// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/sample_rule.h"

#include <algorithm>
#include <map>
#include <utility>

#include "lf/camera/distortion.h"
#include "lf/camera/hood.h"
#include "lf/camera/ray_through.h"
#include "lf/core/check.h"
#include "lf/render/collect/collect.h"
#include "lf/selection/ideal_cells.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

// An LF camera, prepared for many calls of Sees().
struct Viewer {
  RayThrough ray;
  double border_px;  // rays nearer than this to the border of the LF image are ignored
  RayWeights weights;
};

// Returns about the distance, in pixels, that the samples of an element reach to each side of its
// position in the LF image.
double BorderOf(const PinholeCamera& lf_camera, const RenderCamera& camera,
                const PixelReading& reading) {
  return 0.5 + 0.5 * (SamplingOf(lf_camera, camera, reading).samples - 1);
}

// Returns true if the LF image has a ray that passes through point_world and the lens (doc/ray.md,
// rules 2, 3, 5).
bool Sees(const Viewer& viewer, const RenderCamera& camera, const Vec3& point_world) {
  const PinholeCamera& lens = camera.pinhole;
  const Vec3 forward = lens.ForwardWorld();
  const Vec3 offset = viewer.ray.centre_world() - lens.CentreWorld();
  const Vec3 d = viewer.ray.DirectionWorld(point_world);
  if (!(forward.dot(d) > 0)) return false;
  const Vec3 on_lens = offset - d * (forward.dot(offset) / forward.dot(d));
  if (!Contains(camera.aperture, {lens.RightWorld().dot(on_lens), lens.UpWorld().dot(on_lens)}))
    return false;
  if (camera.hood.exists() && !HoodTest(camera).LetsThrough(point_world, d)) return false;
  const std::optional<Vec2> p = viewer.ray.RecordedAt(d);
  const Intrinsics& k = viewer.ray.intrinsics();
  const double border_px = viewer.border_px;
  return p && p->x() >= border_px && p->x() < k.width_px - border_px && p->y() >= border_px &&
         p->y() < k.height_px - border_px;
}

uint64_t LeastCount(const SensorPlate& plate, int x, int y) {
  uint64_t least = plate.At(x, y, 0).count;
  for (int c = 1; c < SensorPlate::kChannels; ++c) least = std::min(least, plate.At(x, y, c).count);
  return least;
}

// Returns how many of `count` elements may have fewer rays than the rule requires.
size_t MayLack(size_t count) {
  return static_cast<size_t>((1 - kMostElements) * static_cast<double>(count));
}

}  // namespace

ReachableElements::ReachableElements(const ImageIndex& index, const RenderCamera& camera,
                                     const RankRange& ranks, const SelectOptions& select,
                                     const PixelReading& reading, ThreadPool& pool,
                                     const std::function<RayWeights(LfImageId)>& weights) {
  const TakingFrame frame = {camera, ranks};
  const std::vector<SelectedImage> images = SelectImages(index, {&frame, 1}, select, pool);
  const LightField& light_field = index.light_field();
  image_count_ = images.size();
  std::map<uint32_t, DistortionMap> maps;
  std::vector<Viewer> viewers;
  for (const SelectedImage& image : images) {
    if (light_field.cameras[image.id.value].is_virtual) continue;
    RayWeights counts = weights ? weights(image.id) : RayWeights();
    if (counts.are_none()) continue;
    const PinholeCamera lf_camera = light_field.Camera(image.id);
    const auto map = maps.try_emplace(light_field.cameras[image.id.value].intrinsics_index,
                                      lf_camera.intrinsics.distortion);
    viewers.push_back({RayThrough(lf_camera, camera.pinhole.ForwardWorld(), map.first->second),
                       select.reach != PixelReach::kOwn ? BorderOf(lf_camera, camera, reading) : 0,
                       std::move(counts)});
  }
  const int width = width_ = camera.pinhole.intrinsics.width_px;
  const int height = height_ = camera.pinhole.intrinsics.height_px;
  columns_ = static_cast<size_t>((width + kGrid - 1) / kGrid);
  const auto rows = static_cast<size_t>((height + kGrid - 1) / kGrid);
  is_reachable_.assign(rows * columns_, 0);
  pool.ForEach(rows, [&](size_t row) {
    for (size_t column = 0; column < columns_; ++column) {
      const int x = std::min(width - 1, static_cast<int>(column) * kGrid + kGrid / 2);
      const int y = std::min(height - 1, static_cast<int>(row) * kGrid + kGrid / 2);
      const std::optional<Vec3> point = FocusPointOfElement(camera, x + 0.5, y + 0.5);
      if (!point) continue;
      is_reachable_[row * columns_ + column] =
          std::any_of(viewers.begin(), viewers.end(), [&](const Viewer& viewer) {
            return Sees(viewer, camera, *point) && viewer.weights.At(x, y) > 0;
          });
    }
  });
  CountElements();
}

void ReachableElements::CountElements() {
  count_ = 0;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) count_ += Holds(x, y) ? 1 : 0;
}

void ReachableElements::Join(const ReachableElements& other) {
  LF_CHECK(width_ == other.width_ && height_ == other.height_);
  for (size_t i = 0; i < is_reachable_.size(); ++i) is_reachable_[i] |= other.is_reachable_[i];
  image_count_ = std::max(image_count_, other.image_count_);
  CountElements();
}

uint32_t DecisionRanks(size_t light_field_image_count, size_t frame_image_count) {
  uint32_t ranks = kDecisionRanks;
  for (size_t taken = 2 * std::max<size_t>(1, frame_image_count);
       taken <= light_field_image_count && ranks < 1u << 30; taken *= 2)
    ranks *= 2;
  return ranks;
}

bool HasSamples(const SensorPlate& plate, const ReachableElements& reachable, uint32_t samples) {
  const size_t may_lack = MayLack(reachable.count());
  size_t lacking = 0;
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x) {
      if (!reachable.Holds(x, y) || LeastCount(plate, x, y) >= samples) continue;
      if (++lacking > may_lack) return false;
    }
  return true;
}

SampleShare MeasureSamples(const SensorPlate& plate, const ReachableElements& reachable,
                           uint32_t samples) {
  if (reachable.count() == 0) return {};
  std::vector<uint64_t> least;
  least.reserve(reachable.count());
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      if (reachable.Holds(x, y)) least.push_back(LeastCount(plate, x, y));
  const auto enough = std::count_if(least.begin(), least.end(),
                                    [samples](uint64_t count) { return count >= samples; });
  const auto at = least.begin() + static_cast<ptrdiff_t>(MayLack(least.size()));
  std::nth_element(least.begin(), at, least.end());
  return {static_cast<double>(enough) / static_cast<double>(least.size()), *at};
}

}  // namespace lf
