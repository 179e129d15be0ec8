// SPDX-License-Identifier: Apache-2.0
// Parses lists of frame numbers, such as "7", "1-10,50-60", and "1-100x2" or "1-100:2" (every
// second frame: 1, 3, 5, ..., 99).
#pragma once

#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

enum class FramesBeyondEnd { kError, kLeftOut };

// Returns the frames in ascending order, each once. kUsage: the text does not have this form, a
// frame is none of `all`, or more than 10 million frames are named, counting repeats. The
// message names `option`.
//   beyond_end  kLeftOut: frames after the last one are left out, so that the result may be empty
Result<std::vector<FrameId>> ParseFrameRange(std::string_view text, const FrameNumbers& all,
                                             const char* option = "{frames}",
                                             FramesBeyondEnd beyond_end = FramesBeyondEnd::kError);

}  // namespace lf
