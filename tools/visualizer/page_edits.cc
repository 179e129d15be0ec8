// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_edits.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <optional>

#include "tools/visualizer/edit_json.h"

#include "lf/core/file.h"
#include "lf/core/spelling.h"
#include "lf/focus/focus_pick.h"
#include "lf/live/shrink.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace {

PageAnswer JsonAnswer(const Json& json) { return {200, "application/json", RecordLine(json)}; }

std::string TextOf(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool IsTrue(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

double NumberOf(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : std::nan("");
}

std::optional<FrameId> FrameOf(const Json& json, const PathFrames& path) {
  const double number = NumberOf(json, "frame");
  if (!(number >= path.frames().first && number <= path.frames().last())) return std::nullopt;
  return FrameId{static_cast<uint32_t>(number)};
}

// Answers with the parser's message, "path.yaml:12:5: ...", and with the line and column in it.
PageAnswer RefusedPath(const Error& error, const std::string& file) {
  Json json = {{"error", Spelled(error.message)}};
  if (error.message.starts_with(file + ":")) {
    const char* at = error.message.data() + file.size() + 1;
    const char* end = error.message.data() + error.message.size();
    for (const char* key : {"line", "column"}) {
      int number = 0;
      const auto [rest, fault] = std::from_chars(at, end, number);
      if (fault != std::errc() || rest == end || *rest != ':') break;
      json[key] = number;
      at = rest + 1;
    }
  }
  return JsonAnswer(json);
}

PageAnswer Save(PageScene& scene, const Json& json) {
  const std::string text = TextOf(json, "text");
  const auto draft = scene.AddDraft(text);
  if (!draft) return RefusedPath(draft.error(), scene.arguments().path.filename().string());
  static std::mutex one_page_at_a_time;  // so that each page sees what another has written
  const std::lock_guard lock(one_page_at_a_time);
  const auto on_disk = scene.TextOnDisk();
  if (!IsTrue(json, "force") && on_disk && IdOfText(*on_disk) != TextOf(json, "expected"))
    return JsonAnswer(
        {{"error", scene.arguments().path.string() +
                       " has been changed by another program since it was opened here"},
         {"conflict", true}});
  if (on_disk && ::access(scene.arguments().path.c_str(), W_OK) != 0)
    return JsonAnswer({{"error", scene.arguments().path.string() +
                                     " is write-protected: allow writing to it, then save again"}});
  if (const auto written = WriteFileAtomically(scene.arguments().path, text); !written)
    return Refusal(written.error());
  return JsonAnswer({{"id", (*draft)->id}});
}

PageAnswer StartPreview(PageScene& scene, PreviewRender& preview, const Json& json) {
  const std::string file = scene.arguments().path.filename().string();
  const auto path = scene.FramesOf(TextOf(json, "text"));
  if (!path) return RefusedPath(path.error(), file);
  const auto frame = FrameOf(json, **path);
  if (!frame) return Refusal(422, "\"frame\": expected a frame of the path");
  if (const auto camera = (*path)->Camera(*frame); !camera)
    return RefusedPath(camera.error(), file);
  preview.Start(*path, *frame, IsTrue(json, "recorded"));
  return JsonAnswer(Json::object());
}

// Answers "live" with a picture, and "lens" with the lens of a picture that the browser renders.
// Only the frame that is shown is checked. The text does not become a draft, because few drafts are
// kept, and a drag would replace those that pages show.
PageAnswer ShowLive(PageScene& scene, LiveView& live, const Json& json, bool is_lens) {
  const std::string file = scene.arguments().path.filename().string();
  const auto path = scene.FramesOf(TextOf(json, "text"));
  if (!path) return RefusedPath(path.error(), file);
  const auto frame = FrameOf(json, **path);
  const double width = NumberOf(json, "width"), budget_ms = NumberOf(json, "budget_ms");
  if (!frame || !(width >= 1))
    return Refusal(422, "expected a frame of the path, and \"width\" from 1 on");
  const int width_px = static_cast<int>(std::min<double>(width, kLongestLiveSide_px));
  const auto whole = (*path)->Camera(*frame);
  if (!whole) return RefusedPath(whole.error(), file);
  const RenderCamera camera = WithPlateWidth(*whole, width_px, kLongestLiveSide_px);
  const double images = NumberOf(json, "images");
  const bool recorded_only = IsTrue(json, "recorded");
  if (is_lens)
    return live.AnswerLens(camera, images >= 1 ? static_cast<size_t>(std::min(images, 1e9)) : 1,
                           recorded_only);
  std::optional<double> budget_s;
  if (budget_ms >= 0) budget_s = budget_ms / 1000;
  return live.Answer(camera, budget_s, recorded_only);
}

PageAnswer PickFocus(PageScene& scene, const Json& json) {
  const std::shared_ptr<PathDraft> draft = scene.FindDraft(TextOf(json, "path"));
  if (!draft) return Refusal(410, "this path has been forgotten: send it again");
  const auto frame = FrameOf(json, *draft->path);
  const double x = NumberOf(json, "x"), y = NumberOf(json, "y");
  if (!frame || !std::isfinite(x) || !std::isfinite(y))
    return Refusal(422, "expected a frame of the path, \"x\" and \"y\"");
  const RenderCamera camera = *draft->path->Camera(*frame);
  std::optional<Ray> ray = RayOfPixel(camera.pinhole, x, y);
  if (json.contains("camera")) {
    const double id = NumberOf(json, "camera");
    if (!(id >= 0 && id < static_cast<double>(scene.light_field().size())))
      return Refusal(422, "\"camera\": expected one of the LF cameras");
    ray = RayOfLfPixel(scene.light_field().Camera(LfImageId{static_cast<uint32_t>(id)}), x, y);
    if (!ray)
      return JsonAnswer(
          {{"error", "the lens of the LF camera sees nothing at this pixel of its image"}});
  }
  const auto pick = FindFocus(scene.light_field(), scene.store(), camera, *ray, scene.pool());
  if (!pick) return JsonAnswer({{"error", Spelled(pick.error().message)}});
  if (pick->certainty < kLeastCertainty)
    return JsonAnswer(
        {{"error", fmt::format("the distance is only {:.0f} % certain: click on an edge or a "
                               "texture, away from outlines of objects in front",
                               100 * pick->certainty)}});
  const double distance_w = FocusDistanceThrough(camera, pick->point_world);
  if (!(distance_w > 0)) return JsonAnswer({{"error", "this point is behind the render camera"}});
  const Vec3& point = pick->point_world;
  Json cameras = Json::array();
  for (const LfImageId id : pick->images) cameras.push_back(id.value);
  return JsonAnswer({{"point", {point.x(), point.y(), point.z()}},
                     {"focus_distance", distance_w},
                     {"certainty", pick->certainty},
                     {"cameras", std::move(cameras)}});
}

}  // namespace

PageAnswer Edit(PageScene& scene, PreviewRender& preview, LiveView& live, std::string_view name,
                const std::string& body) {
  const Json json = ReadEdit(body);
  if (!json.is_object()) return Refusal(400, "expected a JSON object of texts and numbers");
  if (name == "check") {
    const auto draft = scene.AddDraft(TextOf(json, "text"));
    if (!draft) return RefusedPath(draft.error(), scene.arguments().path.filename().string());
    return {200, "application/json", PathHeadJson(**draft)};
  }
  if (name == "save") return Save(scene, json);
  if (name == "preview") return StartPreview(scene, preview, json);
  if (name == "live" || name == "lens") return ShowLive(scene, live, json, name == "lens");
  if (name == "focus") return PickFocus(scene, json);
  if (name == "preview/stop") {
    preview.Stop();
    return JsonAnswer(Json::object());
  }
  return Refusal(404, "there is nothing of this name");
}

}  // namespace lf
