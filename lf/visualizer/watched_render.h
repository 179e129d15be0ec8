// The frames of a render that is at work, or done: what lies in lfrenderer's DIR
// (doc/checkpoints.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

struct WatchedFrame {
  FrameId frame;
  std::filesystem::path picture;  // its newest
  bool is_finished = false;       // or of a checkpoint
  int64_t changed_ns = 0;         // when it was written, since 1970

  friend bool operator==(const WatchedFrame&, const WatchedFrame&) = default;
};

// Finished frames and pictures of unfinished ones, of all packages, by ascending frames; the
// finished one where there are both. A folder that is not there has none.
std::vector<WatchedFrame> LookAtRender(const std::filesystem::path& folder);

struct GrowingPicture {
  int full_width_px = 0;  // of the frame
  int full_height_px = 0;
  bool has_rays = false;
  // [height][width][4]: R, G, B, linear light, and how many rays an element has, the mean of its
  // channels (-1 where the file does not tell). Means of squares where the frame is larger. Frames
  // with alpha are shown over black.
  Image<float> elements;
};

// kInput: as ReadImage(), or fewer than three channels.
Result<GrowingPicture> ReadGrowingPicture(const std::filesystem::path& path, int max_side_px);

}  // namespace lf
