// Answers what the page reads, by name: identical from a server and in an exported folder
// (doc/formats/page_data.md).
#pragma once

#include <string>
#include <string_view>

#include "tools/visualizer/page_scene.h"

#include "lf/core/ids.h"

namespace lf {

struct PageAnswer {
  int status = 200;  // HTTP status
  std::string type = "application/json";
  std::string body;
};

// Returns a refusal with the body {"error": message}.
PageAnswer Refusal(int status, const std::string& message);
PageAnswer Refusal(const Error& error);  // status 507 for kOutput, otherwise 422

// Functions of the page that need a server.
struct PageAbilities {
  bool is_server = true;  // edits, previews, focus picking and news work; false: an export
};

// Returns scene.json: the contents of the scene, and the names of all other data.
//   draft  the path that is shown first
std::string SceneJson(const PageScene& scene, const PathDraft& draft,
                      const PageAbilities& abilities);
// Returns {"id": ..., "fault": ...} for a new text of PATH.yaml, which becomes a draft if it has no
// fault.
std::string PathNewsJson(PageScene& scene, const std::string& text);
// Returns the head of a path, which says what its frames have in common: {"id": ..., "frames": ...,
// ...}.
std::string PathHeadJson(const PathDraft& draft);
// Returns how many frames are examined, and the numbers of LF images and rays of each frame:
// {"done": frames, "total": frames, "images": [...], "rays": [...]}.
std::string FilmJson(const FilmUse::Facts& facts);
// Returns how densely the LF cameras record a frame: {"cameras_in_lens": ..., ...}.
std::string DensityJson(PageScene& scene, const PathDraft& draft, FrameId frame);
// Returns pose and image size of an LF camera: {"id": ..., "name": ..., "centre": [...], ...}.
std::string CameraJson(const PageScene& scene, LfImageId id);
// Returns {"rect": [x_begin, y_begin, x_end, y_end], "outlines": [[[x, y], ...]]}; "rect" is left
// out if no ray of the LF image can contribute.
std::string OverlapJson(PageScene& scene, const PathDraft& draft, FrameId frame, LfImageId id);

// Longest side, in pixels, of the small and of the large picture of an LF image on the page.
inline constexpr int kSmallSide_px = 256;
inline constexpr int kLargeSide_px = 1280;

// Returns the answer for a name, or 404 if it is unknown.
PageAnswer Answer(PageScene& scene, std::string_view name);

}  // namespace lf
