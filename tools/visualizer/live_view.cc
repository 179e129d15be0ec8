// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/live_view.h"

#include <cstdint>
#include <memory>
#include <string>

#include "tools/visualizer/live_bytes.h"

#include "lf/core/parse_number.h"
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

// Returns the whole number, from 0, that the text is; nullopt if it is anything else.
std::optional<int> WholeNumber(std::string_view text) {
  const std::optional<int> number = ParseWhole<int>(text);
  return number && *number >= 0 ? number : std::nullopt;
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
  return is_still ? &still_.emplace_back(is_ending_) : nullptr;
}

void LiveView::End() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  BreakOffStillPictures(false);
}

// Returns the numbers of a live picture that depend on the LF images in memory alone.
Json LiveView::FactsOfImages() const {
  const ResidentImages::Status status = renderer_.images().status();
  Json json = LoadingJson(status);
  json["needed"] = status.needed_count;
  json["image_bytes"] = status.image_bytes;
  json["memory_bytes"] = memory_bytes_;
  json["first_broken"] = status.first_broken;
  json["divisor"] = status.divisor;
  return json;
}

std::string LiveView::BytesOf(const LivePicture& live) const {
  Json json = FactsOfImages();
  json["images"] = live.images.size();
  json["takeable"] = live.takeable_count;
  json["used"] = live.used_count;
  json["uncovered_share"] = live.uncovered_share;
  json["camera_distance"] = live.camera_distance_w;
  json["render_ms"] = 1e3 * live.render_s;
  return WithHead(json) + PictureBytes(PictureOf(live.picture, kLongestSide_px));
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

PageAnswer LiveView::AnswerLens(const RenderCamera& frame, size_t most_images, bool recorded_only) {
  const LiveRenderer::LensPlan plan = renderer_.PlanLens(frame, most_images, recorded_only);
  Json json = FactsOfImages();
  json["takeable"] = plan.takeable_count;
  json["used"] = plan.lens.used_count;
  return {200, "application/octet-stream", LensBytes(plan, frame, std::move(json))};
}

PageAnswer LiveView::AnswerImage(std::string_view name) {
  constexpr std::string_view kEnding = ".bin";
  const PageAnswer refusal = Refusal(404, "this LF image is not in memory");
  const size_t slash = name.find('/');
  if (slash == std::string_view::npos || !name.ends_with(kEnding)) return refusal;
  const std::optional<int> divisor = WholeNumber(name.substr(0, slash));
  const std::optional<int> id =
      WholeNumber(name.substr(slash + 1, name.size() - kEnding.size() - slash - 1));
  if (!id || divisor != renderer_.images().status().divisor) return refusal;
  const std::shared_ptr<const ResidentImages::Snapshot> snapshot =
      renderer_.images().TakeSnapshot();
  for (const ResidentImages::Snapshot::Resident& one : snapshot->images)
    if (one.id.value == static_cast<uint32_t>(*id))
      return {200, "application/octet-stream",
              LfImageBytes(snapshot->field->Camera(one.id), one.image->pixels)};
  return refusal;
}

}  // namespace lf
