#include "lf/live/live_renderer.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "lf/live/lens_order.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/collect/frame_lens.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

constexpr size_t kPlanBytes = size_t{256} << 20;
// Weight of the newest picture in the mean times.
constexpr double kNewest = 0.3;

// Returns the LF images in the order in which the frame takes them, and sets *inside_count to
// LensOrder::inside_count.
std::vector<LfImageId> OrderThroughLens(const LightField& field, const RenderCamera& frame,
                                        const std::map<uint32_t, ResidentImages::Image>& images,
                                        size_t* inside_count) {
  const Intrinsics& k = frame.pinhole.intrinsics;
  const std::optional<Vec3> focus = FocusPointOfElement(frame, 0.5 * k.width_px, 0.5 * k.height_px);
  *inside_count = 0;
  if (!focus) return {};
  std::vector<LfImageId> ids;
  std::vector<Vec2> points;
  for (const auto& [id, image] : images) {
    ids.push_back(LfImageId{id});
    points.push_back(LensPointOfLine(frame, field.Camera(ids.back()).CentreWorld(), *focus));
  }
  const LensOrder order = OrderOverLens(points, frame.aperture.radius_w, points.size());
  *inside_count = order.inside_count;
  std::vector<LfImageId> ordered;
  for (const size_t i : order.indices) ordered.push_back(ids[i]);
  return ordered;
}

// Returns the light field of some LF images, given by ascending ids.
LightField FieldOf(const LightField& field, std::span<const LfImageId> ids) {
  LightField some;
  some.intrinsics = field.intrinsics;
  some.encoding = field.encoding;
  some.unit_m = field.unit_m;
  some.depth_range = field.depth_range;
  for (const LfImageId id : ids) some.cameras.push_back(field.cameras[id.value]);
  some.image_names.resize(ids.size());
  return some;
}

// Moves LF images into a batch for collection, and back again at the end of its life.
class BorrowedImages {
 public:
  BorrowedImages(std::span<const LfImageId> ids, std::map<uint32_t, ResidentImages::Image>& images)
      : batch_(ids.size()) {
    for (uint32_t i = 0; i < ids.size(); ++i) owners_.push_back(&images.at(ids[i].value));
    for (uint32_t i = 0; i < ids.size(); ++i) {
      batch_[i].id = LfImageId{i};
      batch_[i].place = i;
      batch_[i].pixels = std::move(owners_[i]->pixels);
      batch_[i].opacity = std::move(owners_[i]->opacity);
    }
  }
  ~BorrowedImages() {
    for (size_t i = 0; i < batch_.size(); ++i) {
      owners_[i]->pixels = std::move(batch_[i].pixels);
      owners_[i]->opacity = std::move(batch_[i].opacity);
    }
  }
  BorrowedImages(const BorrowedImages&) = delete;
  BorrowedImages& operator=(const BorrowedImages&) = delete;

  std::vector<BatchImage>& batch() { return batch_; }

 private:
  std::vector<BatchImage> batch_;
  std::vector<ResidentImages::Image*> owners_;
};

DevelopOptions DevelopOptionsOf(const RadianceEncoding& encoding) {
  DevelopOptions develop;
  develop.pedestal = encoding.pedestal;
  develop.scale = encoding.Scale();
  develop.white_balance = encoding.white_balance;
  develop.linear_srgb_from_camera = encoding.linear_srgb_from_camera;
  develop.transparent = LfPixels::kTransparent;
  develop.opaque = LfPixels::kOpaque;
  return develop;
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
  LivePicture picture;
  images_.Use([&](const LightField* field, std::map<uint32_t, ResidentImages::Image>& images) {
    static const LightField kNone;
    picture = RenderOf(frame, wish, field ? *field : kNone, images);
  });
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
                                   const LightField& field,
                                   std::map<uint32_t, ResidentImages::Image>& images) {
  const Clock::time_point begin = Clock::now();
  LivePicture live;
  size_t inside_count = 0;
  std::vector<LfImageId> order = OrderThroughLens(field, frame, images, &inside_count);
  live.takeable_count = order.size();
  const size_t most = CountFor(frame, wish);
  // LF images beside the lens get a share of it only if those through it are few.
  if (most < order.size())
    order.resize(std::clamp(inside_count, std::min(kFewestImages, order.size()), most));
  std::sort(order.begin(), order.end());
  live.images = std::move(order);

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
  RayReading reading(Estimator::kBilinear);
  reading.filter = PixelFilter::kBilinear;
  BatchCollector collector(some, std::span(&collected, 1), reading, CollectBackEnd::kFast,
                           kPlanBytes, false, pool_);
  BorrowedImages borrowed(live.images, images);
  std::vector<BatchFrame> frames = {{0, {}, false, {}}};
  const Clock::time_point collecting = Clock::now();
  collector.Add(borrowed.batch(), frames, {}, true, wish.interrupted);
  const double collect_s = SecondsSince(collecting);
  if (const auto facts = lens.facts()) live.uncovered_share = facts->coverage.uncovered_share;
  live.camera_distance_w = lens.camera_distance_w();
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

LiveRenderer::LensPlan LiveRenderer::PlanLens(const RenderCamera& frame, size_t most) {
  images_.Aim(frame);
  LensPlan plan;
  images_.Use([&](const LightField* field, std::map<uint32_t, ResidentImages::Image>& images) {
    if (field == nullptr) return;
    size_t inside_count = 0;
    plan.ids = OrderThroughLens(*field, frame, images, &inside_count);
    plan.takeable_count = plan.ids.size();
    if (most < plan.ids.size())
      plan.ids.resize(std::clamp(inside_count, std::min(kFewestImages, most), most));
    std::sort(plan.ids.begin(), plan.ids.end());
    plan.field = FieldOf(*field, plan.ids);
  });
  plan.lens = LensOfPicture(plan.field, frame, options_.lens_weights, pool_);
  return plan;
}

}  // namespace lf
