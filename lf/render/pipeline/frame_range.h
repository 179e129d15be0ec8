// Parses frame numbers as people write them: "1-100x2" is 1, 3, 5 ...; "7"; "1-10,50-60".
#pragma once

#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

// Returns the frames ascending, each once. kUsage: the text does not have this form, or a frame is
// not in 1 .. frame_count. The message names the option.
Result<std::vector<FrameId>> ParseFrameRange(std::string_view text, size_t frame_count,
                                             const char* option = "--frames");

}  // namespace lf
