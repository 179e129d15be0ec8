// SPDX-License-Identifier: Apache-2.0
#include "lf/live/resident_images.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "lf/live/lens_order.h"
#include "lf/live/shrink.h"
#include "lf/render/collect/around_lens.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/select.h"

namespace lf {
namespace {

// LF images are loaded for a lens that is wider by this factor, so that an aperture can be opened
// a little before anything must be loaded, ...
constexpr double kWiderLens = 1.25;
// ... and at least by this many distances between LF cameras, because lens weights give LF cameras
// beside the lens a share (doc/lens-integral.md).
constexpr double kBesideLens_distances = 3;

// Frames need the same LF images if they differ little but in focus.
constexpr double kSameFocus = 1.2;

bool SeeAlike(const RenderCamera& a, const RenderCamera& b) {
  const double ratio = a.focus_distance_w / b.focus_distance_w;
  return a.pinhole.intrinsics == b.pinhole.intrinsics &&
         a.pinhole.cam_from_world.rotation == b.pinhole.cam_from_world.rotation &&
         a.pinhole.cam_from_world.translation == b.pinhole.cam_from_world.translation &&
         a.aperture.radius_w == b.aperture.radius_w && ratio < kSameFocus && ratio > 1 / kSameFocus;
}

}  // namespace

ResidentImages::ResidentImages(const ImageIndex& index, const LfImageStore& store,
                               size_t memory_bytes, int threads, std::function<void()> changed,
                               double retry_s)
    : index_(index),
      store_(store),
      memory_bytes_(memory_bytes),
      changed_(std::move(changed)),
      retry_after_(retry_s),
      pool_(threads),
      thread_([this] { Run(); }) {}

ResidentImages::~ResidentImages() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    news_.notify_all();
  }
  thread_.join();
}

void ResidentImages::Aim(const RenderCamera& frame) {
  const std::lock_guard lock(mutex_);
  const std::optional<RenderCamera>& current = aim_ ? aim_ : last_;
  const bool retries = !status_.first_broken.empty() && Clock::now() - failed_at_ >= retry_after_;
  if (current && SeeAlike(*current, frame) && !retries) return;
  aim_ = frame;
  news_.notify_all();
}

std::shared_ptr<const ResidentImages::Snapshot> ResidentImages::TakeSnapshot() const {
  const std::lock_guard lock(images_mutex_);
  if (snapshot_) return snapshot_;
  Snapshot snapshot = {field_, {}};
  snapshot.images.reserve(images_.size());
  for (const auto& [id, image] : images_) snapshot.images.push_back({LfImageId{id}, image});
  snapshot_ = std::make_shared<const Snapshot>(std::move(snapshot));
  return snapshot_;
}

ResidentImages::Status ResidentImages::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void ResidentImages::WaitUntilLoaded() {
  std::unique_lock lock(mutex_);
  news_.wait(lock, [&] { return is_ending_ || (!aim_ && !is_loading_); });
}

void ResidentImages::Run() {
  while (true) {
    RenderCamera frame;
    {
      std::unique_lock lock(mutex_);
      is_loading_ = false;
      news_.notify_all();
      news_.wait(lock, [&] { return is_ending_ || aim_; });
      if (is_ending_) return;
      frame = *std::exchange(aim_, std::nullopt);
      last_ = frame;
      is_loading_ = true;
    }
    try {
      LoadFor(frame);
    } catch (const std::exception& error) {  // such as lack of memory
      Tell([&](Status* status) {
        status->first_broken = error.what();
        failed_at_ = Clock::now();
      });
    }
  }
}

// Returns true if LF images that could not be loaded are to be tried again now.
bool ResidentImages::TakesRetry() {
  const std::lock_guard lock(mutex_);
  if (Clock::now() - failed_at_ < retry_after_) return false;
  // The next retry waits again, even if another frame ends this one before it has failed.
  failed_at_ = Clock::now();
  return true;
}

void ResidentImages::LoadFor(const RenderCamera& frame) {
  UseDivisor(DivisorFor(index_, frame, field_ ? status().divisor : 0));
  const Wanted wanted = WantedBy(frame);
  const bool retries = TakesRetry();
  std::vector<LfImageId> missing;
  for (const LfImageId id : wanted.ids)
    if (!images_.contains(id.value) && (retries || !broken_.contains(id.value)))
      missing.push_back(id);
  Tell([&](Status* status) {
    status->first_broken = broken_.empty() ? "" : broken_.begin()->second;
    status->needed_count = wanted.needed_count;
    status->wanted_count = wanted.ids.size();
    status->wanted_done_count = wanted.ids.size() - missing.size();
  });
  // The first pictures should have a few LF images soon, later ones need not change so often.
  const auto threads = static_cast<size_t>(pool_.thread_count());
  // At least some are loaded, even if the camera moves all the time.
  for (size_t begin = 0, count = 0; begin < missing.size() && (begin == 0 || !HasNews());
       begin += count) {
    count = std::min(missing.size() - begin, begin < 4 * threads ? threads : 4 * threads);
    LoadSome(wanted, {missing.begin() + static_cast<ptrdiff_t>(begin),
                      missing.begin() + static_cast<ptrdiff_t>(begin + count)});
  }
  const std::lock_guard lock(mutex_);
  spare_.clear();
}

// Begins anew if the divisor changes.
void ResidentImages::UseDivisor(int divisor) {
  if (field_ && divisor == status().divisor) return;
  auto field = std::make_shared<const LightField>(ShrunkField(index_.light_field(), divisor));
  for (const auto& [id, image] : images_) forgotten_.push_back(image);
  {
    const std::lock_guard lock(images_mutex_);
    snapshot_ = nullptr;
    images_.clear();
    field_ = std::move(field);
  }
  Tell([&](Status* status) {
    status->divisor = divisor;
    status->image_bytes = ImageBytes();
    status->resident_count = status->wanted_done_count = 0;
  });
}

// Returns the memory of the largest LF image.
size_t ResidentImages::ImageBytes() const {
  size_t image_bytes = 1;
  for (const Intrinsics& k : field_->intrinsics)
    image_bytes = std::max(image_bytes, static_cast<size_t>(k.width_px) * k.height_px *
                                            LfPixels::kRgbLanes * sizeof(uint16_t));
  if (field_->encoding.HasOpacity()) image_bytes *= 2;
  return image_bytes;
}

size_t ResidentImages::Capacity() const {
  return std::max<size_t>(1, memory_bytes_ / ImageBytes());
}

ResidentImages::Wanted ResidentImages::WantedBy(const RenderCamera& frame) {
  Wanted wanted;
  const Intrinsics& k = frame.pinhole.intrinsics;
  const std::optional<Vec3> focus = FocusPointOfElement(frame, 0.5 * k.width_px, 0.5 * k.height_px);
  if (!focus) return wanted;
  RenderCamera wider = frame;
  const double radius_w = frame.aperture.radius_w;
  wider.aperture = {
      std::max(kWiderLens * radius_w,
               radius_w + kBesideLens_distances * CameraDistanceAround(index_, frame)),
      0, 0};
  SelectOptions select;
  select.reach = PixelReach::kNeighbours;
  select.interrupted = &is_ending_;
  std::vector<SelectedImage> images = SelectImages(index_, std::span(&wider, 1), select, pool_);
  if (is_ending_) return wanted;
  wanted.needed_count = images.size();
  const auto rest = std::stable_partition(images.begin(), images.end(), [&](const auto& image) {
    return images_.contains(image.id.value);
  });
  std::vector<Vec2> points;
  for (const SelectedImage& image : images)
    points.push_back(
        LensPointOfLine(frame, index_.light_field().Camera(image.id).CentreWorld(), *focus));
  const auto loaded_count = static_cast<size_t>(rest - images.begin());
  for (const size_t i : OrderOverLens(points, radius_w, Capacity(), loaded_count).indices) {
    wanted.ids.push_back(images[i].id);
    wanted.set.insert(images[i].id.value);
  }
  return wanted;
}

bool ResidentImages::HasNews() const {
  const std::lock_guard lock(mutex_);
  return is_ending_ || aim_;
}

void ResidentImages::LoadSome(const Wanted& wanted, const std::vector<LfImageId>& some) {
  const LightField& field = index_.light_field();
  std::vector<Result<Image>> loaded(some.size(), Result<Image>(Image()));
  const int divisor = status().divisor;
  pool_.ForEach(some.size(), [&](size_t i) {
    LfPixels pixels = TakeSpare();
    const Result<int> reduced =
        LoadReducedWithoutThrowing(store_, some[i], divisor, field.Camera(some[i]).intrinsics,
                                   field.image_names[some[i].value], &pixels);
    if (!reduced) {
      loaded[i] = reduced.error();
      return;
    }
    Shrink(pixels, divisor / *reduced, &loaded[i]->pixels);
    loaded[i]->opacity = loaded[i]->pixels.TakeOpacity();
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(pixels));
  });
  MakeRoom(wanted, some.size());
  WaitForForgotten();
  bool has_failed = false;
  for (size_t i = 0; i < some.size(); ++i) {
    if (!loaded[i]) {
      broken_[some[i].value] = loaded[i].error().message;
      has_failed = true;
      continue;
    }
    broken_.erase(some[i].value);
    auto image = std::make_shared<const Image>(*std::move(loaded[i]));
    const std::lock_guard lock(images_mutex_);
    snapshot_ = nullptr;
    images_[some[i].value] = std::move(image);
  }
  Tell([&](Status* status) {
    status->wanted_done_count += some.size();
    status->resident_count = images_.size();
    status->broken_count = broken_.size();
    status->first_broken = broken_.empty() ? "" : broken_.begin()->second;
    if (has_failed) failed_at_ = Clock::now();
  });
}

// Returns memory for an LF image in full size, which is reused. If each LF image got new memory,
// holes between the shrunken LF images would double the memory that the process takes.
LfPixels ResidentImages::TakeSpare() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return {};
  LfPixels pixels = std::move(spare_.back());
  spare_.pop_back();
  return pixels;
}

// Forgets LF images that are not wanted until there is room for `count` more.
void ResidentImages::MakeRoom(const Wanted& wanted, size_t count) {
  const size_t capacity = Capacity();
  const std::lock_guard lock(images_mutex_);
  snapshot_ = nullptr;
  for (auto image = images_.begin(); images_.size() + count > capacity && image != images_.end();) {
    if (wanted.set.contains(image->first)) {
      ++image;
      continue;
    }
    forgotten_.push_back(image->second);
    image = images_.erase(image);
  }
}

// Waits until snapshots hold at most an eighth as many forgotten LF images as there is room for.
void ResidentImages::WaitForForgotten() {
  constexpr size_t kForgottenShare = 8;
  constexpr auto kPause = std::chrono::milliseconds(5);
  const size_t most = Capacity() / kForgottenShare;
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    std::erase_if(forgotten_, [](const auto& image) { return image.expired(); });
    if (forgotten_.size() <= most) return;
    news_.wait_for(lock, kPause);
  }
}

void ResidentImages::Tell(const std::function<void(Status*)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(&status_);
    ++status_.version;
  }
  if (changed_) changed_();
}

}  // namespace lf
