// Answers the POST requests of the page: checking and saving paths, previews, focus picking.
#pragma once

#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_scene.h"
#include "tools/visualizer/preview_render.h"

namespace lf {

// Answers a POST request by its name; its body is JSON. Mistakes of the user are answered with
// "error"; HTTP errors are for requests that the page never makes.
//   check         {"text"} -> the head of the path (PathHeadJson), or "error", "line", "column"
//   save          {"text", "expected": id of PATH.yaml's text as the page knows it, "force"}
//                 -> {"id"}; "conflict" with "error" if the file was changed meanwhile
//   preview       {"text", "frame"} -> {}; events report its progress
//   preview/stop  {} -> {}
//   focus         {"path": id, "frame", "x", "y"} in elements of the frame, or, with "camera", in
//                 pixels of its LF image
//                 -> {"point", "focus_distance", "certainty", "cameras"}
PageAnswer Edit(PageScene& scene, PreviewRender& preview, std::string_view name,
                const std::string& body);

}  // namespace lf
