// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_answers.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "tools/visualizer/render_folder.h"

#include "lf/core/parse_number.h"
#include "lf/pixels/files/write_jpeg.h"
#include "lf/view/lf_picture.h"
#include "lf/view/scene_bytes.h"
#include "lf/view/shown_frames.h"

namespace lf {
namespace {

constexpr int kJpegQuality = 88;
constexpr const char* kBytes = "application/octet-stream";
constexpr size_t kFramesPerBlock = 256;  // as in web/src/path_frames.ts

// The parts of a name such as "path/0123/use/7.bin" between the slashes; the last part has no
// ending.
struct Name {
  std::vector<std::string> parts;
  std::string ending;  // such as ".bin"
};

Name Split(std::string_view text) {
  Name name;
  const size_t dot = text.rfind('.');
  if (dot != std::string_view::npos) {
    name.ending = text.substr(dot);
    text = text.substr(0, dot);
  }
  while (true) {
    const size_t slash = text.find('/');
    name.parts.emplace_back(text.substr(0, slash));
    if (slash == std::string_view::npos) return name;
    text = text.substr(slash + 1);
  }
}

// Parses a decimal number in [begin, end).
std::optional<uint32_t> NumberOf(const std::string& text, size_t begin, size_t end) {
  const std::optional<uint32_t> number = ParseWhole<uint32_t>(text);
  return number && *number >= begin && *number < end ? number : std::nullopt;
}

PageAnswer NotFound() { return Refusal(404, "there is nothing of this name"); }

PageAnswer JsonAnswer(std::string body) { return {200, "application/json", std::move(body)}; }
PageAnswer BytesAnswer(std::string body) { return {200, kBytes, std::move(body)}; }

// Answers scene.json with the path that is in PATH.yaml now. If that has a fault, which an event
// reports, answers with the path that was there when lfvisualizer started.
PageAnswer OfScene(PageScene& scene) {
  if (const auto text = scene.TextOnDisk())
    if (const auto draft = scene.AddDraft(*text)) return JsonAnswer(SceneJson(scene, **draft, {}));
  return JsonAnswer(SceneJson(scene, *scene.first_draft(), {}));
}

PageAnswer OfImage(PageScene& scene, const Name& name) {
  if (name.parts.size() != 3 || name.ending != ".jpg") return NotFound();
  const auto side = NumberOf(name.parts[1], 1, kLargeSide_px + 1);
  const auto id = NumberOf(name.parts[2], 0, scene.light_field().size());
  if (!id || (side != kSmallSide_px && side != kLargeSide_px)) return NotFound();
  const auto picture =
      LfPicture(scene.light_field(), scene.store(), LfImageId{*id}, static_cast<int>(*side));
  if (!picture) return Refusal(picture.error());
  auto jpeg = EncodeJpeg(picture->view(), kJpegQuality);
  if (!jpeg) return Refusal(jpeg.error());
  return {200, "image/jpeg", *std::move(jpeg)};
}

// Answers with a block: the cameras of kFramesPerBlock consecutive frames.
PageAnswer OfBlock(const PathDraft& draft, const Name& name) {
  const size_t frame_count = draft.path->frame_count();
  const auto number =
      NumberOf(name.parts[3], 0, (frame_count + kFramesPerBlock - 1) / kFramesPerBlock);
  if (!number || name.parts.size() != 4 || name.ending != ".bin") return NotFound();
  std::vector<FrameId> frames;
  for (size_t i = *number * kFramesPerBlock; i < frame_count; ++i) {
    frames.push_back(draft.path->frames().At(i));
    if (frames.size() == kFramesPerBlock) break;
  }
  return BytesAnswer(FramesBytes(*draft.path, frames));
}

PageAnswer OfFrame(PageScene& scene, PathDraft& draft, const Name& name) {
  const std::string& kind = name.parts[2];
  if (kind == "frames") return OfBlock(draft, name);
  const FrameNumbers all = draft.path->frames();
  const auto frame_number = NumberOf(name.parts[3], all.first, size_t{all.last()} + 1);
  if (!frame_number) return NotFound();
  const FrameId frame{*frame_number};
  if (name.parts.size() == 4 && kind == "use" && name.ending == ".bin")
    return BytesAnswer(FrameUseBytes(scene.light_field(), scene.UseOf(draft, frame)));
  if (name.parts.size() == 4 && kind == "density" && name.ending == ".json")
    return JsonAnswer(DensityJson(scene, draft, frame));
  if (name.parts.size() == 5 && kind == "overlap" && name.ending == ".json") {
    const auto id = NumberOf(name.parts[4], 0, scene.light_field().size());
    if (id) return JsonAnswer(OverlapJson(scene, draft, frame, LfImageId{*id}));
  }
  return NotFound();
}

PageAnswer OfPath(PageScene& scene, const Name& name) {
  if (name.parts.size() < 3) return NotFound();
  const std::shared_ptr<PathDraft> draft = scene.FindDraft(name.parts[1]);
  if (!draft) return Refusal(410, "this path has been forgotten: send it again");
  if (name.parts.size() > 3) return OfFrame(scene, *draft, name);
  const std::string file = name.parts[2] + name.ending;
  if (file == "path.json") return JsonAnswer(PathHeadJson(*draft));
  if (file == "path.yaml") return {200, "text/plain; charset=utf-8", draft->text};
  if (file == "frames.bin")
    return BytesAnswer(FramesBytes(*draft->path, ShownFrames(draft->path->frames())));
  if (file == "film.json") return JsonAnswer(FilmJson(scene.FilmOf(*draft)->Get()));
  if (file == "film.bin") return BytesAnswer(FilmUseBytes(scene.FilmOf(*draft)->Get()));
  return NotFound();
}

}  // namespace

PageAnswer Answer(PageScene& scene, std::string_view name) {
  if (name == "scene.json") return OfScene(scene);
  if (name == "cameras.bin") return BytesAnswer(CamerasBytes(scene.light_field()));
  const Name split = Split(name);
  if (split.parts[0] == "image") return OfImage(scene, split);
  if (split.parts[0] == "path") return OfPath(scene, split);
  if (split.parts[0] == "camera" && split.parts.size() == 2 && split.ending == ".json")
    if (const auto id = NumberOf(split.parts[1], 0, scene.light_field().size()))
      return JsonAnswer(CameraJson(scene, LfImageId{*id}));
  if (split.parts[0] == "depth" && split.parts.size() == 2 && split.ending == ".bin")
    if (const auto file = NumberOf(split.parts[1], 0, scene.depths().size()))
      return BytesAnswer(DepthBytes(scene.depths()[*file].points));
  if (split.parts[0] == "watch" && !scene.arguments().watch.empty())
    return AnswerOfRender(scene.arguments().watch, name.substr(std::min(name.size(), size_t{6})));
  return NotFound();
}

}  // namespace lf
