// SPDX-License-Identifier: Apache-2.0
#include "lf/view/shown_frames.h"

#include <algorithm>
#include <cstdint>

namespace lf {

// The last frame counts as one of kMostShownFrames, in addition to every step-th frame.
size_t ShownStep(size_t frame_count) {
  if (frame_count <= kMostShownFrames) return 1;
  return (frame_count - 1 + kMostShownFrames - 2) / (kMostShownFrames - 1);
}

std::vector<FrameId> ShownFrames(const FrameNumbers& frames) {
  const size_t step = ShownStep(frames.count);
  std::vector<FrameId> shown;
  for (size_t i = 0; i < frames.count; i += step) shown.push_back(frames.At(i));
  if (!shown.empty() && shown.back().value < frames.last()) shown.push_back({frames.last()});
  return shown;
}

}  // namespace lf
