// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/export_live.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/visualizer/live_bytes.h"

#include "lf/live/lens_order.h"
#include "lf/live/shrink.h"
#include "lf/live/undistort.h"
#include "lf/pixels/files/write_jpeg.h"
#include "lf/pixels/files/write_png.h"
#include "lf/render/state/record_fields.h"
#include "lf/view/lf_picture.h"

namespace lf {
namespace {

constexpr int kJpegQuality = 92;
constexpr int kPictureWidth_px =
    640;  // widest live pictures for which the LF images have enough pixels
constexpr int kLeastWidth_px = 120;  // LF images are not made narrower to fit the bound
// The page keeps 8 bytes for each pixel on the graphics card (web/src/live/gl/gl_renderer.ts).
constexpr double kMostPixels = (256 << 20) / 8.0;
constexpr double kFileShare = 4.0 / 3;  // a file has the encoded LF image in base 64
constexpr size_t kMostOrdered = 2048;   // largest number of exported LF images that the film uses
constexpr size_t kMostForUsed = 2;      // most exported LF images for each that the film uses
constexpr size_t kMeasured = 4;         // LF images that are encoded to estimate the size of all

Intrinsics ShrunkIntrinsics(const LightField& field, LfImageId id, int divisor) {
  LightField one;
  one.intrinsics = {field.Camera(id).intrinsics};
  return ShrunkField(std::move(one), divisor).intrinsics[0];
}

// Returns the intrinsics of an exported LF image.
Intrinsics ExportedIntrinsics(const LightField& field, const LivePlan& plan, LfImageId id) {
  return plan.pinhole ? *plan.pinhole : ShrunkIntrinsics(field, id, plan.divisor);
}

// Sets LivePlan::pinhole, or LivePlan::refused.
void PlanUndistorted(const LightField& field, LivePlan* plan) {
  plan->pinhole.reset();
  const bool is_distorted = std::any_of(field.intrinsics.begin(), field.intrinsics.end(),
                                        [](const Intrinsics& k) { return k.has_distortion(); });
  if (!is_distorted) return;
  LightField lenses;
  lenses.intrinsics = field.intrinsics;
  plan->pinhole = CommonPinhole(ShrunkField(std::move(lenses), plan->divisor).intrinsics);
  if (!plan->pinhole)
    plan->refused = "the LF cameras have distorted lenses that see too different regions";
}

// Returns ids of used LF images, at most kMostOrdered, in an order of which every beginning is
// spread evenly over their LF cameras, as seen by the frame in the middle of the film.
std::vector<LfImageId> SpreadOut(const LightField& field, std::span<const uint32_t> used,
                                 const RenderCamera& frame) {
  std::vector<LfImageId> some;
  const size_t count = std::min(used.size(), kMostOrdered);
  for (size_t i = 0; i < count; ++i) some.push_back(LfImageId{used[i * used.size() / count]});
  std::vector<Vec2> places;
  for (const LfImageId id : some) {
    const Vec3 offset = field.Camera(id).CentreWorld() - frame.pinhole.CentreWorld();
    places.emplace_back(frame.pinhole.RightWorld().dot(offset),
                        frame.pinhole.UpWorld().dot(offset));
  }
  std::vector<LfImageId> ordered;
  for (const size_t i : FarthestPointOrder(places, count)) ordered.push_back(some[i]);
  return ordered;
}

// Appends LF images that the film does not use, the nearest to the lens first, until there are
// `count`. Pictures need them if a user opens the lens wider or moves the camera.
void AddOthers(const LightField& field, const RenderCamera& frame, size_t count,
               std::vector<LfImageId>* ids) {
  std::vector<bool> is_there(field.size(), false);
  for (const LfImageId id : *ids) is_there[id.value] = true;
  std::vector<std::pair<double, LfImageId>> others;
  for (uint32_t i = 0; i < field.size(); ++i)
    if (!is_there[i])
      others.emplace_back(
          (field.Camera(LfImageId{i}).CentreWorld() - frame.pinhole.CentreWorld()).norm(),
          LfImageId{i});
  std::sort(others.begin(), others.end());
  for (size_t i = 0; i < others.size() && ids->size() < count; ++i)
    ids->push_back(others[i].second);
}

// Returns the mean size of the files of the first few LF images, in bytes; nullopt if none of them
// can be read.
std::optional<double> MeanBytes(const PageScene& scene, const LivePlan& plan) {
  double sum = 0, count = 0;
  const std::span<const LfImageId> ids = plan.ids;
  for (const LfImageId id : ids.first(std::min(ids.size(), kMeasured)))
    if (const auto encoded = EncodeForLive(scene, plan, id)) {
      sum += kFileShare * static_cast<double>(encoded->bytes.size());
      ++count;
    }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace

LivePlan PlanLiveExport(PageScene& scene, std::span<const uint32_t> used, size_t most_bytes) {
  LivePlan plan;
  const LightField& field = scene.light_field();
  if (field.encoding.HasOpacity()) plan.refused = "the LF images have opacities";
  if (plan.refused.empty() && used.empty()) plan.refused = "the film uses no LF images";
  if (plan.refused.empty() && most_bytes == 0) plan.refused = "--export-live 0 leaves them out";
  if (!plan.refused.empty()) return plan;
  const PathFrames& path = *scene.first_draft()->path;
  if (path.Camera(path.frames().At(0))->transmission) {
    plan.refused = "the lens has a transmission";
    return plan;
  }
  const RenderCamera frame = *path.Camera(path.frames().At(path.frame_count() / 2));
  plan.ids = SpreadOut(field, used, frame);
  plan.divisor =
      DivisorFor(scene.index(), WithPlateWidth(frame, kPictureWidth_px, 2 * kPictureWidth_px), 0);
  while (true) {
    PlanUndistorted(field, &plan);
    if (!plan.refused.empty()) return plan;
    const Intrinsics k = ExportedIntrinsics(field, plan, plan.ids.front());
    const std::optional<double> mean_bytes = MeanBytes(scene, plan);
    if (!mean_bytes) break;  // the export reports that they cannot be read
    const double room = std::min(static_cast<double>(most_bytes) / *mean_bytes,
                                 kMostPixels / (static_cast<double>(k.width_px) * k.height_px));
    const int coarser = plan.divisor + std::max(1, plan.divisor / 2);
    const bool fits = room >= static_cast<double>(plan.ids.size());
    if (!fits && k.width_px * plan.divisor / coarser >= kLeastWidth_px) {
      plan.divisor = coarser;
      continue;
    }
    if (!fits) plan.ids.resize(std::max<size_t>(1, static_cast<size_t>(room)));
    if (fits)
      AddOthers(field, frame,
                std::min(kMostForUsed * plan.ids.size(), static_cast<size_t>(std::min(room, 1e9))),
                &plan.ids);
    break;
  }
  return plan;
}

Result<EncodedLfImage> EncodeForLive(const PageScene& scene, const LivePlan& plan, LfImageId id) {
  const LightField& field = scene.light_field();
  LfPixels full, pixels;
  LF_ASSIGN_OR_RETURN(
      const int reduced,
      LoadReducedWithoutThrowing(scene.store(), id, plan.divisor, field.Camera(id).intrinsics,
                                 field.ImagePath(id).string(), &full));
  Shrink(full, plan.divisor / reduced, &pixels);
  if (plan.pinhole) {
    LfPixels distorted = std::move(pixels);
    Undistort(distorted, ShrunkIntrinsics(field, id, plan.divisor), *plan.pinhole, &pixels);
  }
  const int channels = pixels.any_masked ? 4 : 3;
  Image<uint8_t> picture(pixels.rect.width(), pixels.rect.height(), channels, 0);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      if (pixels.IsMasked(x, y)) continue;
      const uint16_t* const value = &pixels.radiance.at(x, y, 0);
      const auto colour = DisplayColour(field.encoding, Vec3(value[0], value[1], value[2]));
      std::copy(colour.begin(), colour.end(), &picture.at(x, y, 0));
      if (channels == 4) picture.at(x, y, 3) = 255;
    }
  EncodedLfImage encoded;
  encoded.ending = pixels.any_masked ? ".png" : ".jpg";
  LF_ASSIGN_OR_RETURN(encoded.bytes, pixels.any_masked ? EncodePng(picture.view())
                                                       : EncodeJpeg(picture.view(), kJpegQuality));
  return encoded;
}

std::string LiveJson(const PageScene& scene, const LivePlan& plan,
                     std::span<const std::string> names) {
  const LightField& field = scene.light_field();
  Json images = Json::array();
  for (size_t i = 0; i < plan.ids.size(); ++i) {
    if (names[i].empty()) continue;
    PinholeCamera camera = field.Camera(plan.ids[i]);
    camera.intrinsics = ExportedIntrinsics(field, plan, plan.ids[i]);
    Json image = LfCameraJson(camera);
    image["id"] = plan.ids[i].value;
    image["name"] = names[i];
    images.push_back(std::move(image));
  }
  return RecordLine({{"refused", plan.refused}, {"divisor", plan.divisor}, {"images", images}});
}

}  // namespace lf
