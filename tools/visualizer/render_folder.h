// Answers requests of the page about the folder of a watched render: frames.json lists its frames,
// and 7.bin is the picture of frame 7.
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
