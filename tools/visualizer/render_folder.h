// The folder of a render as the page sees it: frames.json, and 7.bin of a frame.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"

namespace lf {

// {"folder": ..., "frames": [{"frame": 1, "finished": true, "changed": "..."}]}
std::string RenderJson(const std::filesystem::path& folder);

// "frames.json" or "FRAME.bin".
PageAnswer AnswerOfRender(const std::filesystem::path& folder, std::string_view name);

}  // namespace lf
