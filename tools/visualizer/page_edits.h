// What the page asks to be done: paths checked and saved, previews, focus picking.
#pragma once

#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_scene.h"
#include "tools/visualizer/preview_render.h"

namespace lf {

// By names, with JSON bodies:
//   check         {"text"} -> the head of the path (PathHeadJson), or 422 with "line", "column"
//   save          {"text", "expected": id of PATH.yaml's text as the page knows it, "force"}
//                 -> {"id"}; 409 where the file is another meanwhile
//   preview       {"text", "frame"} -> {}; how it goes is told by events
//   preview/stop  {} -> {}
//   focus         {"path": id, "frame", "x", "y"} in elements, or with "camera", in its pixels
//                 -> {"point", "focus_distance", "certainty", "cameras"}
PageAnswer Edit(PageScene& scene, PreviewRender& preview, std::string_view name,
                const std::string& body);

}  // namespace lf
