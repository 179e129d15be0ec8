// SPDX-License-Identifier: Apache-2.0
// Answers the requests of the page for data, by name (doc/formats/page_data.md). An export has the
// same answers as files, except that scene.json says that there is no server.
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
  std::string fault = {};  // message of a refusal, as plain text; empty if this is none
};

// Returns a refusal with the body {"error": message}.
PageAnswer Refusal(int status, const std::string& message);
PageAnswer Refusal(const Error& error);  // status 507 for kOutput, otherwise 422

// Functions of the page that need a server.
struct PageAbilities {
  bool is_server = true;  // true: edits, previews, focus picking and news work; false: an export
};

// Returns scene.json: the light field, the head of a path, the options, the packages and their
// frames, the watched folder, the depth files, and `abilities`.
//   draft  the path, which the page shows first
std::string SceneJson(const PageScene& scene, const PathDraft& draft,
                      const PageAbilities& abilities);
// Returns {"id": IdOfText(), "fault": message of the parser} for a new text of PATH.yaml. If the
// text has no fault, "fault" is "", and the text becomes a draft.
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
// Returns {"rect": [x_begin, y_begin, x_end, y_end], "outlines": [[[x, y], ...]]} in pixels of the
// LF image. "rect" is the rectangle that the frame reads (its ends are exclusive); left out if the
// frame does not read the LF image. "outlines" are those of OverlapOutlines().
std::string OverlapJson(PageScene& scene, const PathDraft& draft, FrameId frame, LfImageId id);

// Longest side, in pixels, of the small and of the large picture of an LF image on the page.
inline constexpr int kSmallSide_px = 256;
inline constexpr int kLargeSide_px = 1280;

// Returns the answer for a name, or a refusal: 404 if the name is unknown, 410 if it is that of a
// forgotten path, 422 or 507 if the picture of an image cannot be made.
PageAnswer Answer(PageScene& scene, std::string_view name);

}  // namespace lf
