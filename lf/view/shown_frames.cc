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

std::vector<FrameId> ShownFrames(size_t frame_count) {
  const size_t step = ShownStep(frame_count);
  std::vector<FrameId> frames;
  for (size_t frame = 1; frame <= frame_count; frame += step)
    frames.push_back(FrameId{static_cast<uint32_t>(frame)});
  if (!frames.empty() && frames.back().value < frame_count)
    frames.push_back(FrameId{static_cast<uint32_t>(frame_count)});
  return frames;
}

}  // namespace lf
