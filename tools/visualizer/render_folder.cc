// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/render_folder.h"

#include <fmt/format.h>

#include "lf/render/state/record_fields.h"
#include "lf/view/scene_bytes.h"
#include "lf/view/watched_render.h"

namespace lf {
namespace {

constexpr int kWatchedSide_px = 1280;

}  // namespace

std::string RenderJson(const std::filesystem::path& folder) {
  Json frames = Json::array();
  for (const WatchedFrame& frame : LookAtRender(folder))
    // "changed" is text, because the page compares it exactly, and JavaScript numbers have only 53
    // bits.
    frames.push_back({{"frame", frame.frame.value},
                      {"finished", frame.is_finished},
                      {"changed", std::to_string(frame.changed_ns)},
                      {"changed_s", frame.changed_ns / 1'000'000'000}});
  const Json json = {{"folder", folder.string()}, {"frames", std::move(frames)}};
  return RecordLine(json);
}

PageAnswer AnswerOfRender(const std::filesystem::path& folder, std::string_view name) {
  if (name == "frames.json") return {200, "application/json", RenderJson(folder)};
  for (const WatchedFrame& frame : LookAtRender(folder)) {
    if (name != fmt::format("{}.bin", frame.frame.value)) continue;
    const auto picture = ReadGrowingPicture(frame.picture, kWatchedSide_px);
    if (!picture) return Refusal(picture.error());
    return {200, "application/octet-stream", PictureBytes(*picture)};
  }
  return Refusal(404, "there is no such frame yet");
}

}  // namespace lf
