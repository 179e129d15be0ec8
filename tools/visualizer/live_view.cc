#include "tools/visualizer/live_view.h"

#include <cstdint>
#include <cstring>
#include <string>

#include "lf/core/check.h"
#include "lf/render/state/record_fields.h"
#include "lf/view/scene_bytes.h"
#include "lf/view/watched_render.h"

namespace lf {
namespace {

constexpr int kLongestSide_px = 4096;  // live pictures are smaller, and are never reduced

LiveOptions OptionsOf(const PageArguments& arguments, size_t memory_bytes) {
  LiveOptions options;
  options.memory_bytes = memory_bytes;
  options.lens_weights = arguments.needs.lens_weights;
  return options;
}

Json LoadingJson(const ResidentImages::Status& status) {
  return {{"resident", status.resident_count},
          {"wanted", status.wanted_count},
          {"done", status.wanted_done_count},
          {"broken", status.broken_count}};
}

}  // namespace

LiveView::LiveView(PageScene& scene, size_t memory_bytes)
    : scene_(scene),
      memory_bytes_(memory_bytes),
      pool_(scene.arguments().threads),
      renderer_(scene.index(), scene.store(), OptionsOf(scene.arguments(), memory_bytes), pool_,
                [this] { Tell(); }) {}

void LiveView::Tell() {
  const ResidentImages::Status status = renderer_.images().status();
  Json json = LoadingJson(status);
  json["version"] = status.version;
  scene_.events().Post("live", RecordLine(json));
}

// Breaks off the still pictures that are waited for. Returns the flag of a new one if is_still is
// true, otherwise null.
std::atomic<bool>* LiveView::BreakOffStillPictures(bool is_still) {
  const std::lock_guard lock(mutex_);
  for (std::atomic<bool>& flag : still_) flag = true;
  return is_still ? &still_.emplace_back(false) : nullptr;
}

// Returns the length of the JSON text, the text, and the picture, which begins at a multiple of 4
// bytes.
std::string LiveView::BytesOf(const LivePicture& live) const {
  const ResidentImages::Status status = renderer_.images().status();
  Json json = LoadingJson(status);
  json["images"] = live.images.size();
  json["needed"] = status.needed_count;
  json["image_bytes"] = status.image_bytes;
  json["memory_bytes"] = memory_bytes_;
  json["takeable"] = live.takeable_count;
  json["first_broken"] = status.first_broken;
  json["divisor"] = status.divisor;
  json["uncovered_share"] = live.uncovered_share;
  json["camera_distance"] = live.camera_distance_w;
  json["render_ms"] = 1e3 * live.render_s;
  std::string text = RecordLine(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<uint32_t>(text.size());
  std::string bytes(sizeof(length), '\0');
  std::memcpy(bytes.data(), &length, sizeof(length));
  return bytes + text + PictureBytes(PictureOf(live.picture, kLongestSide_px));
}

PageAnswer LiveView::Answer(const RenderCamera& frame, std::optional<double> budget_s,
                            bool recorded_only) {
  std::atomic<bool>* const flag = BreakOffStillPictures(!budget_s);
  const Result<LivePicture> live = renderer_.Render(frame, {budget_s, recorded_only, flag});
  if (flag != nullptr) {
    const std::lock_guard lock(mutex_);
    still_.remove_if([&](const std::atomic<bool>& one) { return &one == flag; });
  }
  if (!live) return {200, "application/json", RecordLine({{"superseded", true}})};
  return {200, "application/octet-stream", BytesOf(*live)};
}

}  // namespace lf
