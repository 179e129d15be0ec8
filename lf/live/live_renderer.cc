// SPDX-License-Identifier: Apache-2.0
#include "lf/live/live_renderer.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "lf/live/lens_order.h"
#include "lf/live/picture_lens.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/develop_options.h"
#include "lf/render/collect/frame_lens.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

constexpr size_t kPlanBytes = size_t{256} << 20;
// Number of LF images that are collected at once, so that their plans take little memory. A picture
// can be interrupted between two such groups.
constexpr size_t kTogether = 128;
// Weight of the newest picture in the mean times.
constexpr double kNewest = 0.3;

using Resident = ResidentImages::Snapshot::Resident;

// Returns the LF images that the frame takes, by ascending ids.
//   most  largest number of LF images
std::vector<Resident> ImagesThroughLens(const LightField& field,
                                        const std::vector<Resident>& images,
                                        const RenderCamera& frame, size_t most) {
  const Intrinsics& k = frame.pinhole.intrinsics;
  const std::optional<Vec3> focus = FocusPointOfElement(frame, 0.5 * k.width_px, 0.5 * k.height_px);
  if (!focus) return {};
  if (most >= images.size()) return images;
  std::vector<Vec2> points;
  for (const Resident& one : images)
    points.push_back(LensPointOfLine(frame, field.Camera(one.id).CentreWorld(), *focus));
  const LensOrder order = OrderOverLens(points, frame.aperture.radius_w, most);
  // LF images beside the lens get a share of it only if those through it are few.
  const size_t fewest = std::min({LiveRenderer::kFewestImages, images.size(), most});
  const size_t count = std::clamp(order.inside_count, fewest, most);
  std::vector<Resident> taken;
  for (size_t i = 0; i < count; ++i) taken.push_back(images[order.indices[i]]);
  std::sort(taken.begin(), taken.end(),
            [](const Resident& a, const Resident& b) { return a.id.value < b.id.value; });
  return taken;
}

// Returns the LF images in memory that a picture may take.
//   recorded_only  as in LiveWish
std::vector<Resident> TakeableOf(const ResidentImages::Snapshot& snapshot, bool recorded_only) {
  if (!recorded_only) return snapshot.images;
  std::vector<Resident> recorded;
  std::copy_if(
      snapshot.images.begin(), snapshot.images.end(), std::back_inserter(recorded),
      [&](const Resident& one) { return !snapshot.field->cameras[one.id.value].is_virtual; });
  return recorded;
}

// Returns the light field of some LF images, given by ascending ids. It has only the intrinsics
// that these LF images have, because finding the angle that a distorted lens sees takes long.
LightField FieldOf(const LightField& field, std::span<const LfImageId> ids) {
  LightField some;
  some.encoding = field.encoding;
  some.unit_m = field.unit_m;
  some.depth_range = field.depth_range;
  std::map<uint32_t, uint32_t> index_of;  // index into some.intrinsics by index into those of field
  for (const LfImageId id : ids) {
    LfCamera camera = field.cameras[id.value];
    const auto [found, is_new] = index_of.try_emplace(
        camera.intrinsics_index, static_cast<uint32_t>(some.intrinsics.size()));
    if (is_new) some.intrinsics.push_back(field.intrinsics[camera.intrinsics_index]);
    camera.intrinsics_index = found->second;
    some.cameras.push_back(camera);
  }
  some.image_names.resize(ids.size());
  return some;
}

// Returns the LF images [begin, end) for collection. Their ids are indices of `images`.
std::vector<BatchImage> BatchOf(std::span<const Resident> images, size_t begin, size_t end) {
  std::vector<BatchImage> batch(end - begin);
  for (size_t i = begin; i < end; ++i) {
    BatchImage& one = batch[i - begin];
    one.id = LfImageId{static_cast<uint32_t>(i)};
    one.rank = one.id.value;
    one.shared_pixels = &images[i].image->pixels;
    one.shared_opacity = &images[i].image->opacity;
  }
  return batch;
}

// Collects the LF images into the frame. Once *interrupted is true, LF images are left out.
//   field  light field of the LF images
void CollectAll(const LightField& field, std::span<const Resident> images,
                const CollectedFrame& frame, const std::atomic<bool>* interrupted,
                ThreadPool& pool) {
  RayReading reading(Estimator::kBilinear);
  reading.filter = PixelFilter::kBilinear;
  BatchCollector collector(field, std::span(&frame, 1), reading, CollectBackEnd::kFast, kPlanBytes,
                           false, pool);
  for (size_t begin = 0; begin < images.size(); begin += kTogether) {
    std::vector<BatchImage> batch =
        BatchOf(images, begin, std::min(begin + kTogether, images.size()));
    std::vector<BatchFrame> frames = {{0, {}, false, {}}};
    collector.Add(batch, frames, {}, true, interrupted);
  }
}

}  // namespace

LiveRenderer::LiveRenderer(const ImageIndex& index, const LfImageStore& store,
                           const LiveOptions& options, ThreadPool& pool,
                           std::function<void()> changed)
    : options_(options),
      pool_(pool),
      images_(index, store, options.memory_bytes, pool.thread_count(), std::move(changed)) {}

Result<LivePicture> LiveRenderer::Render(const RenderCamera& frame, const LiveWish& wish) {
  const std::lock_guard lock(mutex_);
  if (wish.interrupted != nullptr && *wish.interrupted)
    return Error{ErrorKind::kInterrupted, "interrupted"};
  images_.Aim(frame);
  LivePicture picture = RenderOf(frame, wish, images_.TakeSnapshot());
  if (wish.interrupted != nullptr && *wish.interrupted)
    return Error{ErrorKind::kInterrupted, "interrupted"};
  return picture;
}

// Returns the number of LF images for which there is time.
size_t LiveRenderer::CountFor(const RenderCamera& frame, const LiveWish& wish) const {
  if (!wish.budget_s) return SIZE_MAX;
  const Intrinsics& k = frame.pinhole.intrinsics;
  const double of_image_s = ray_s_ * k.width_px * k.height_px;
  const double count = std::max(0.0, *wish.budget_s - rest_s_) / of_image_s;
  return std::max(kFewestImages, static_cast<size_t>(std::min(count, 1e9)));
}

LivePicture LiveRenderer::RenderOf(const RenderCamera& frame, const LiveWish& wish,
                                   std::shared_ptr<const ResidentImages::Snapshot> snapshot) {
  const Clock::time_point begin = Clock::now();
  LivePicture live;
  static const LightField kNone;
  const std::shared_ptr<const LightField> kept = snapshot->field;
  const LightField& field = kept ? *kept : kNone;
  std::vector<Resident> takeable = TakeableOf(*snapshot, wish.recorded_only);
  live.takeable_count = takeable.size();
  const std::vector<Resident> images =
      ImagesThroughLens(field, takeable, frame, CountFor(frame, wish));
  takeable.clear();
  snapshot = nullptr;  // LF images that the picture does not take may be forgotten
  for (const Resident& one : images) live.images.push_back(one.id);

  const LightField some = FieldOf(field, live.images);
  const ImageIndex index(some);
  SelectOptions select;
  select.reach = PixelReach::kNeighbours;
  const FrameLens lens(index, frame, options_.lens_weights, select, pool_);
  const Intrinsics& plate = frame.pinhole.intrinsics;
  live.plate = SensorPlate(plate.width_px, plate.height_px, PlateKindOf(some.encoding, false));
  CollectedFrame collected = {lens.camera(), &live.plate};
  if (options_.lens_weights != LensWeights::kNone)
    collected.weights = [&](LfImageId id) { return lens.WeightsOf(id); };
  const Clock::time_point collecting = Clock::now();
  CollectAll(some, images, collected, wish.interrupted, pool_);
  const double collect_s = SecondsSince(collecting);
  if (const auto facts = lens.facts()) live.uncovered_share = facts->coverage.uncovered_share;
  live.camera_distance_w = lens.camera_distance_w();
  live.used_count = UsedCount(lens, index, select, pool_);
  if (wish.interrupted != nullptr && *wish.interrupted) return live;
  live.picture = Develop(live.plate, DevelopOptionsOf(some.encoding), pool_);
  live.render_s = SecondsSince(begin);
  if (!live.images.empty()) {
    const double rays = static_cast<double>(live.images.size()) * plate.width_px * plate.height_px;
    ray_s_ += kNewest * (collect_s / rays - ray_s_);
    rest_s_ += kNewest * (live.render_s - collect_s - rest_s_);
  }
  return live;
}

LiveRenderer::LensPlan LiveRenderer::PlanLens(const RenderCamera& frame, size_t most,
                                              bool recorded_only) {
  images_.Aim(frame);
  LensPlan plan;
  const std::shared_ptr<const ResidentImages::Snapshot> snapshot = images_.TakeSnapshot();
  if (snapshot->field) {
    const std::vector<Resident> takeable = TakeableOf(*snapshot, recorded_only);
    plan.takeable_count = takeable.size();
    for (const Resident& one : ImagesThroughLens(*snapshot->field, takeable, frame, most))
      plan.ids.push_back(one.id);
    plan.field = FieldOf(*snapshot->field, plan.ids);
  }
  plan.lens = LensOfPicture(plan.field, frame, options_.lens_weights, pool_);
  return plan;
}

}  // namespace lf
