// SPDX-License-Identifier: Apache-2.0
// Answers requests of the page about the folder of a watched render: frames.json lists its frames,
// and 7.bin is the picture of frame 7.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"

namespace lf {

// Returns {"folder": ..., "frames": [{"frame": 1, "finished": true, "changed": "...", "changed_s":
// ...}]}. "changed" is WatchedFrame::changed_ns, the time of the picture's last change, as text;
// "changed_s" is the same time in whole seconds since 1970, as a number.
std::string RenderJson(const std::filesystem::path& folder);

// Answers the names "frames.json" (with RenderJson()) and "FRAME.bin"; with 404 for a frame that
// has no picture, and for other names.
PageAnswer AnswerOfRender(const std::filesystem::path& folder, std::string_view name);

}  // namespace lf
