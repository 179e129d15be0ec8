// SPDX-License-Identifier: Apache-2.0
// Finds the frames of a running or finished render in the output folder of lfrenderer
// (doc/checkpoints.md), and makes small pictures of them for the page of lfvisualizer.
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
  std::filesystem::path picture;  // file of the newest finished picture, or else from a checkpoint
  bool is_finished = false;       // false: the picture is from a checkpoint
  int64_t changed_ns = 0;         // modification time of `picture`, in nanoseconds since 1970

  friend bool operator==(const WatchedFrame&, const WatchedFrame&) = default;
};

// Returns the frames of all packages that have a picture, finished or from a checkpoint, by
// ascending numbers. If a frame has both pictures, the finished one is returned. A missing folder
// has no frames.
std::vector<WatchedFrame> LookAtRender(const std::filesystem::path& folder);

struct GrowingPicture {
  int full_width_px = 0;  // width and height of the frame itself
  int full_height_px = 0;
  bool has_rays = false;  // true if the numbers of rays are known
  // [height][width][4]: R, G, B in linear light, and the number of rays of an element (with lens
  // weights: the sum of their weights), averaged over its channels (-1 if has_rays is false). If
  // the longer side of the frame exceeds max_side_px of the function that returns this picture,
  // each entry is the mean of a square of elements. A frame with alpha is shown over
  // black.
  Image<float> elements;
};

// Returns the picture of a frame that this process has rendered.
GrowingPicture PictureOf(const DevelopedFrame& frame, int max_side_px);

// Reads the picture of a frame from its file. kInput: the errors of ReadImage(); the file has fewer
// than three channels.
Result<GrowingPicture> ReadGrowingPicture(const std::filesystem::path& path, int max_side_px);

}  // namespace lf
