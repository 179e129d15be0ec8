// SPDX-License-Identifier: Apache-2.0
// Answers the POST requests of the page: checking and saving paths, previews, focus picking.
#pragma once

#include <string>
#include <string_view>

#include "tools/visualizer/live_view.h"
#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_scene.h"
#include "tools/visualizer/preview_render.h"

namespace lf {

// Longest side of a live picture, in elements; larger ones are answered with smaller ones.
inline constexpr int kLongestLiveSide_px = 1280;

// Answers a POST request by its name; its body is JSON. Mistakes of the user are answered with
// status 200 and {"error": message}. Refusals have the status 410 for a path that has been
// forgotten, 507 or 422 if PATH.yaml cannot be written, and others for requests that the page never
// makes.
//   check         {"text"} -> the head of the path (PathHeadJson); for a faulty path {"error"}, and
//                 "line" and "column" if they are known
//   save          {"text", "expected": id of PATH.yaml's text as the page knows it, "force"}
//                 -> {"id"}; {"error", "conflict": true} if the file was changed meanwhile and
//                 "force" is not true
//   preview       {"text", "frame", "recorded"} -> {}; events report the progress of the render. If
//                 "recorded" is true, virtual LF images are left out
//   preview/stop  {} -> {}
//   live          {"text", "frame", "width": of the picture, in elements; "budget_ms": time for it,
//                 or left out for a still picture; "recorded" as in preview} -> bytes of a picture
//                 (doc/formats/page_data.md); {"error"} as for check if the text or this frame is
//                 faulty. Other frames are not checked;
//                 {"superseded": true} for a still picture that a newer request has broken off
//   lens          {"text", "frame", "width", "recorded", "images": largest number of LF images} ->
//                 bytes of the lens of a picture that the browser renders
//   focus         {"path": id, "frame", "x", "y"}; x and y are in elements of the frame or, if
//                 "camera" names an LF camera, in pixels of its LF image
//                 -> {"point": position in the world, "focus_distance": in world units,
//                 "certainty": from 0 to 1, "cameras": LF cameras that were compared}
PageAnswer Edit(PageScene& scene, PreviewRender& preview, LiveView& live, std::string_view name,
                const std::string& body);

}  // namespace lf
