// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/lens_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "lf/camera/resolution.h"
#include "lf/live/shrink.h"
#include "lf/live/undistort.h"

namespace lf {
namespace {

constexpr int kLeastRows = 16;
constexpr size_t kBytesPerPixel = 4 * sizeof(uint16_t);
constexpr double kMargin_px = 2;  // for interpolation between pixels

std::array<uint16_t, 65536> MakeRoots() {
  std::array<uint16_t, 65536> roots;
  for (size_t v = 0; v < roots.size(); ++v)
    roots[v] = static_cast<uint16_t>(std::lround(std::sqrt(65535.0 * static_cast<double>(v))));
  return roots;
}

const std::array<uint16_t, 65536>& Roots() {
  static const std::array<uint16_t, 65536> roots = MakeRoots();
  return roots;
}

// Returns the intrinsics of an image whose pixels are means of divisor x divisor pixels.
Intrinsics ReducedIntrinsics(const Intrinsics& k, int divisor) {
  LightField one;
  one.intrinsics = {k};
  return ShrunkField(std::move(one), divisor).intrinsics[0];
}

}  // namespace

uint16_t RootOfLight(uint16_t v) { return Roots()[v]; }

uint16_t LightOfRoot(uint16_t root) {
  const auto r = static_cast<uint64_t>(root);
  return static_cast<uint16_t>((r * r + 32767) / 65535);
}

Vec3 PointAt(const RenderCamera& frame, double x, double y, double distance_w) {
  const Ray ray = RayOfPixel(frame.pinhole, x, y);
  return ray.origin + distance_w / frame.pinhole.ForwardWorld().dot(ray.direction) * ray.direction;
}

PlanePositions::PlanePositions(const LensView& view, const RenderCamera& frame, double distance_w) {
  // A point at the distance g is  c + g R^T K^-1 (x, y, 1), because the last row of K is (0, 0, 1).
  const Mat3 to_pixel = view.camera.intrinsics.Matrix() * view.camera.cam_from_world.rotation;
  const Mat3 from_element = distance_w * frame.pinhole.cam_from_world.rotation.transpose() *
                            frame.pinhole.intrinsics.InverseMatrix();
  const Mat3 by_element = to_pixel * from_element;
  Vec3 constant = to_pixel * (frame.pinhole.CentreWorld() - view.camera.CentreWorld());
  by_x = by_element.col(0);
  by_y = by_element.col(1);
  start = by_element.col(2) + constant;
}

LensViews::LensViews(const LightField& light_field, const LfImageStore& store,
                     const RenderCamera& frame, std::vector<LensCamera> cameras,
                     const DepthRange& depths, int margin, bool strict)
    : light_field_(light_field),
      store_(store),
      frame_(frame),
      depths_(depths),
      margin_(margin),
      strict_(strict) {
  // Elements are at most about twice as wide as the pixels of reduced images: the median of the LF
  // cameras decides.
  std::vector<double> finer;
  for (const LensCamera& camera : cameras) {
    const Intrinsics& k = light_field.Camera(camera.id).intrinsics;
    finer.push_back(k.fx_px / frame.pinhole.intrinsics.fx_px);
  }
  if (!finer.empty()) {
    std::nth_element(finer.begin(), finer.begin() + finer.size() / 2, finer.end());
    while (2 * divisor_ <= finer[finer.size() / 2] + 0.25) divisor_ *= 2;
  }
  for (LensCamera& camera : cameras) {
    Source source;
    source.of = camera;
    source.camera = light_field.Camera(camera.id);
    Intrinsics k = ReducedIntrinsics(source.camera.intrinsics, divisor_);
    if (k.has_distortion()) {
      const std::optional<Intrinsics> pinhole = CommonPinhole(std::span(&k, 1));
      if (!pinhole) continue;  // the lens sees too little of what a pinhole camera would
      k = *pinhole;
    }
    source.camera.intrinsics = k;
    sources_.push_back(source);
  }
}

// Returns the bounds of the pixels that the elements of the part see at any of the depths; empty if
// they see none, or if some of the points are behind the LF camera.
PixelRect LensViews::SeenFrom(const PinholeCamera& camera, const PixelRect& part) const {
  double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
  for (const double distance_w : {depths_.near_w, depths_.far_w})
    for (const int x : {part.x_begin - margin_, part.x_end + margin_})
      for (const int y : {part.y_begin - margin_, part.y_end + margin_}) {
        const Vec3 point = camera.cam_from_world * PointAt(frame_, x, y, distance_w);
        if (!(point.z() > 0)) return {};
        const Vec3 at = camera.intrinsics.Matrix() * point;
        left = std::min(left, at.x() / at.z());
        right = std::max(right, at.x() / at.z());
        top = std::min(top, at.y() / at.z());
        bottom = std::max(bottom, at.y() / at.z());
      }
  const auto pixel = [](double at, int size) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(size)));
  };
  const Intrinsics& k = camera.intrinsics;
  return {pixel(left - kMargin_px, k.width_px), pixel(top - kMargin_px, k.height_px),
          pixel(right + kMargin_px + 1, k.width_px), pixel(bottom + kMargin_px + 1, k.height_px)};
}

Result<std::vector<PixelRect>> LensViews::CutPlate(size_t memory_bytes) const {
  const int width = frame_.pinhole.intrinsics.width_px;
  const int height = frame_.pinhole.intrinsics.height_px;
  const auto bytes_of = [&](const PixelRect& part) {
    size_t bytes = 0;
    for (const Source& source : sources_)
      bytes += kBytesPerPixel * static_cast<size_t>(std::max<int64_t>(
                                    0, SeenFrom(source.camera, part).pixel_count()));
    return bytes;
  };
  const auto largest = [&](int rows) {
    size_t bytes = 0;
    for (int y = 0; y < height; y += rows)
      bytes = std::max(bytes, bytes_of({0, y, width, std::min(height, y + rows)}));
    return bytes;
  };
  int rows = height;
  size_t needed = largest(rows);
  while (rows > kLeastRows && needed > memory_bytes) {
    rows = std::max(kLeastRows, (rows + 1) / 2);
    needed = largest(rows);
  }
  if (needed > memory_bytes)
    return OutputError(fmt::format(
        "{{memory {} KiB}} is too small: the LF images of {} rows of {} elements need at "
        "least {} KiB; give more, or compare fewer LF images by {{views}}",
        memory_bytes >> 10, rows, width, (needed >> 10) + 1));
  std::vector<PixelRect> parts;
  for (int y = 0; y < height; y += rows) parts.push_back({0, y, width, std::min(height, y + rows)});
  return parts;
}

Result<void> LensViews::LoadView(const Source& source, const PixelRect& rect,
                                 LensView* view) const {
  const Intrinsics& k = light_field_.Camera(source.of.id).intrinsics;
  const std::string& name = light_field_.image_names[source.of.id.value];
  LfPixels pixels, reduced;
  LF_ASSIGN_OR_RETURN(const int done,
                      LoadReducedWithoutThrowing(store_, source.of.id, divisor_, k, name, &pixels));
  if (done < divisor_) {
    Shrink(pixels, divisor_ / done, &reduced);
    std::swap(pixels, reduced);
  }
  if (k.has_distortion()) {
    Undistort(pixels, ReducedIntrinsics(k, divisor_), source.camera.intrinsics, &reduced);
    std::swap(pixels, reduced);
  }
  view->of = source.of;
  view->camera = source.camera;
  view->rect = Intersection(rect, pixels.rect);
  view->light = Image<uint16_t>(view->rect.width(), view->rect.height(), LfPixels::kRgbLanes);
  for (int y = 0; y < view->light.height(); ++y)
    for (int x = 0; x < view->light.width(); ++x) {
      const int column = x + view->rect.x_begin - pixels.rect.x_begin;
      const int row = y + view->rect.y_begin - pixels.rect.y_begin;
      if (pixels.IsMasked(column, row)) {
        view->any_masked = true;
        continue;
      }
      for (int c = 0; c < 3; ++c)
        view->light.at(x, y, c) = RootOfLight(pixels.radiance.at(column, row, c));
      view->light.at(x, y, LfPixels::kRayLane) = 1;
    }
  return {};
}

Result<void> LensViews::Load(const PixelRect& part, ThreadPool& pool,
                             const std::atomic<bool>* stop) {
  if (part == loaded_part_) return {};
  loaded_part_ = {};
  views_.clear();
  std::vector<LensView> views(sources_.size());
  std::mutex mutex;
  Result<void> outcome = {};
  MachineFailure machine;
  pool.ForEach(sources_.size(), [&](size_t i) {
    Source& source = sources_[i];
    const PixelRect rect = SeenFrom(source.camera, part);
    if (source.is_broken || rect.empty() || (stop != nullptr && *stop)) return;
    const Result<void> loaded = LoadView(source, rect, &views[i]);
    if (loaded) return;
    machine.Note(loaded.error());
    const std::lock_guard lock(mutex);
    source.is_broken = true;
    views[i] = {};
    if (strict_ && outcome) outcome = loaded.error();
    skipped_.push_back(
        {light_field_.image_names[source.of.id.value], loaded.error().message, source.of.id.value});
  });
  LF_RETURN_IF_ERROR(machine.Check());
  LF_RETURN_IF_ERROR(outcome);
  if (stop != nullptr && *stop) return Error{ErrorKind::kInterrupted, "interrupted"};
  std::sort(skipped_.begin(), skipped_.end(),
            [](const SkippedImage& a, const SkippedImage& b) { return a.rank < b.rank; });
  for (LensView& view : views)
    if (!view.rect.empty() && view.rect.width() > 1 && view.rect.height() > 1)
      views_.push_back(std::move(view));
  loaded_part_ = part;
  return {};
}

}  // namespace lf
