// What the page asks to be done: paths checked and saved, previews, focus picking.
#pragma once

#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_scene.h"
#include "tools/visualizer/preview_render.h"

namespace lf {

// By names, with JSON bodies. What a person does wrong is answered as well, with "error": HTTP's
// own errors are for requests that no page makes.
//   check         {"text"} -> the head of the path (PathHeadJson), or "error", "line", "column"
//   save          {"text", "expected": id of PATH.yaml's text as the page knows it, "force"}
//                 -> {"id"}; "conflict" with "error" where the file is another meanwhile
//   preview       {"text", "frame"} -> {}; how it goes is told by events
//   preview/stop  {} -> {}
//   focus         {"path": id, "frame", "x", "y"} in elements, or with "camera", in its pixels
//                 -> {"point", "focus_distance", "certainty", "cameras"}
PageAnswer Edit(PageScene& scene, PreviewRender& preview, std::string_view name,
                const std::string& body);

}  // namespace lf
