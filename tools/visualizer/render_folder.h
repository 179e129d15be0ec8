// The folder of a render in the form that the page reads: frames.json, and 7.bin for a frame.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"

namespace lf {

// Returns {"folder": ..., "frames": [{"frame": 1, "finished": true, "changed": "..."}]}.
std::string RenderJson(const std::filesystem::path& folder);

// Answers the names "frames.json" and "FRAME.bin".
PageAnswer AnswerOfRender(const std::filesystem::path& folder, std::string_view name);

}  // namespace lf
