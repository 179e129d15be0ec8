// SPDX-License-Identifier: Apache-2.0
// Joins the frames of a film of views into pictures, or into a video.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/view_layout.h"

namespace lf {

struct ViewFilmOptions {
  ViewLayout layout = ViewLayout::kQuilt;
  TileCounts grid = {};  // of a quilt
  // FOLDER/NAME.png or .exr, as the frames, .png of EXR frames, or .mp4. PathOfViews() gives the
  // names of the files; a film of one moment has pictures without a number.
  std::filesystem::path output;
  // Frame rate of the video. By default that which the frames state, or 30, with a warning.
  std::optional<double> fps = {};
  bool resume = false;     // keep files of the same frames and options, and write the others
  bool overwrite = false;  // replace the files that exist
  std::function<bool()> is_interrupted = {};
  // Size of a tile of a quilt, into which the whole views are squeezed, as displays want it whose
  // quilts have tiles of another aspect; none: that of the views. The name keeps the views' aspect.
  std::optional<ViewSize> tile = {};
  // Width of the views divided by their height, which is checked to one percent; none: any.
  std::optional<double> aspect = {};
};

struct ViewFilmReport {
  size_t moment_count = 0;
  int view_count = 0;
  int width = 0, height = 0;  // of a joined picture, in pixels
  std::optional<double> fps;  // of the video
  std::vector<std::filesystem::path> files;
  size_t kept_count = 0;  // files that existed and were kept
};

// Writes the pictures or the video of a film. Everything is checked before the first file is
// written. A picture has the type, the primaries and the frame rate of the frames; with kLeftRight,
// pictures are copies of the frames. A video (develop/video.h), and a PNG file of EXR frames, is
// 8-bit sRGB, composited over black. Each file appears under its name when it is complete.
//   frames       as for FindViewMoments()
//   on_progress  called when a view has been joined, by one thread at a time; may be empty
// Each file that is no copy of a frame states what it was made of (file_inputs.h): its layout, and
// a hash of its frames. kUsage: the extension of the output fits neither the frames nor a video; a
// file exists, and neither resume nor overwrite is set; resume is set, and a file was made of other
// frames or in another way; a file would replace a frame; fps without a video; a tile is larger
// than the views; the views have another aspect. kInput: errors of FindViewMoments(),
// CommonHeader(), JoinedChannels(); the joined picture would have more than 2^30 pixels, or, for
// the video of a quilt, an odd size. kOutput: a file cannot be written, ffmpeg is missing, or
// another call writes files of this name. kInterrupted: complete files stay.
Result<ViewFilmReport> WriteViewFilm(
    std::span<const std::filesystem::path> frames, const ViewFilmOptions& options, ThreadPool& pool,
    const std::function<void(size_t done, size_t total)>& on_progress);

}  // namespace lf
