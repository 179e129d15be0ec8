// What the page reads, by name: the same from a server and in an exported folder
// (doc/formats/page_data.md).
#pragma once

#include <string>
#include <string_view>

#include "tools/visualizer/page_scene.h"

#include "lf/core/ids.h"

namespace lf {

struct PageAnswer {
  int status = 200;  // of HTTP
  std::string type = "application/json";
  std::string body;
};

// {"error": ...}
PageAnswer Refusal(int status, const std::string& message);
PageAnswer Refusal(const Error& error);  // 422: input, 507: disk and memory

// What the page can do besides looking.
struct PageAbilities {
  bool is_server = true;  // edits, previews, focus picking, news; else an exported folder
};

// scene.json: what there is, and under which names the rest is found.
//   draft  the path to begin with
std::string SceneJson(const PageScene& scene, const PathDraft& draft,
                      const PageAbilities& abilities);
// {"id": ..., "fault": ...} of what PATH.yaml has become; its text is a draft if there is no fault.
std::string PathNewsJson(PageScene& scene, const std::string& text);
// {"id": ..., "frames": ..., ...} of a path.
std::string PathHeadJson(const PathDraft& draft);
// {"done": frames, "total": frames, "images": [...], "rays": [...]}
std::string FilmJson(const FilmUse::Facts& facts);
// {"cameras_in_lens": ..., ...}
std::string DensityJson(PageScene& scene, const PathDraft& draft, FrameId frame);
// {"id": ..., "name": ..., "centre": [...], ...}
std::string CameraJson(const PageScene& scene, LfImageId id);
// {"rect": [x_begin, y_begin, x_end, y_end], "outlines": [[[x, y], ...]]}; no rect: no ray
std::string OverlapJson(PageScene& scene, const PathDraft& draft, FrameId frame, LfImageId id);

// Of LF images, at most so many pixels each way.
inline constexpr int kSmallSide_px = 256;
inline constexpr int kLargeSide_px = 1280;

// 404 for other names.
PageAnswer Answer(PageScene& scene, std::string_view name);

}  // namespace lf
