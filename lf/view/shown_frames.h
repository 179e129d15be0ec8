// SPDX-License-Identifier: Apache-2.0
// The shown frames: those whose data the page has at once (curves, the line of the path, counts of
// LF images). A long film shows only some of its frames, so that data do not grow with its length.
#pragma once

#include <cstddef>
#include <vector>

#include "lf/core/ids.h"

namespace lf {

// The largest number of shown frames. A timeline is fewer pixels wide.
inline constexpr size_t kMostShownFrames = 10'000;

// Returns the distance between two shown frames: 1 if all are shown.
size_t ShownStep(size_t frame_count);
// Returns the shown frames of a film, ascending: each ShownStep()-th from the first on, and the
// last.
std::vector<FrameId> ShownFrames(const FrameNumbers& frames);

}  // namespace lf
