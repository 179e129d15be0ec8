// Finds the frames of a render that is running or done, in the DIR of lfrenderer
// (doc/checkpoints.md), and shrinks pictures for the page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"

namespace lf {

struct WatchedFrame {
  FrameId frame;
  std::filesystem::path picture;  // the newest picture of the frame
  bool is_finished = false;       // false: the picture is of a checkpoint
  int64_t changed_ns = 0;         // modification time since 1970

  friend bool operator==(const WatchedFrame&, const WatchedFrame&) = default;
};

// Returns finished frames and pictures of unfinished ones, of all packages, by ascending frames. If
// a frame has both, the finished one is returned. A missing folder has no frames.
std::vector<WatchedFrame> LookAtRender(const std::filesystem::path& folder);

struct GrowingPicture {
  int full_width_px = 0;  // of the full frame
  int full_height_px = 0;
  bool has_rays = false;
  // [height][width][4]: R, G, B in linear light, and the rays of an element, averaged over its
  // channels (-1 if the file does not state them). If the frame is larger than max_side_px, these
  // are means of squares. Frames with alpha are shown over black.
  Image<float> elements;
};

// Returns the picture of a frame that is rendered in this process.
GrowingPicture PictureOf(const DevelopedFrame& frame, int max_side_px);

// kInput: errors of ReadImage(), or fewer than three channels.
Result<GrowingPicture> ReadGrowingPicture(const std::filesystem::path& path, int max_side_px);

}  // namespace lf
