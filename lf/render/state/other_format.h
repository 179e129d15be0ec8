// SPDX-License-Identifier: Apache-2.0
// Frames that an earlier render with another --format left in the output folder.
#pragma once

#include <filesystem>
#include <span>

#include "lf/core/ids.h"
#include "lf/film/develop/frame_file.h"

namespace lf {

// Warns of files in `folder` that are named as frames of `frames`, but with the extension of
// another format than `format`. They stay beside the new frames, because they may be wanted, and
// would be mistaken for them.
void WarnOfOtherFormat(const std::filesystem::path& folder, std::span<const FrameId> frames,
                       FrameFormat format);

}  // namespace lf
