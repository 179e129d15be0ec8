// SPDX-License-Identifier: Apache-2.0
// The folder that the frames of a film are rendered into, and how a render is watched and
// interrupted.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/picture.h"

namespace lf {

// Requests to a render in progress. Code that sets `stop` or `save` must set `attention`
// afterwards. Signal handlers may set all three.
struct RenderSignals {
  std::atomic<bool> attention = false;  // true: the work pauses soon, to read `stop` and `save`
  std::atomic<bool> stop = false;       // true: the state is written, and the render ends
  std::atomic<bool> save = false;       // true: the state is written, and the render continues
};

// The folder that the frames and the state of a render go into. Only output_folder has no default.
struct FolderOptions {
  std::filesystem::path output_folder;  // is made if it does not exist
  // Files other than LF images that the program reads, such as the calibration and the path. No
  // output may replace them. RenderFilm() adds those that it knows.
  std::vector<std::filesystem::path> inputs = {};
  // Files that `complete` writes, and that no other output may be.
  std::vector<std::filesystem::path> more_outputs = {};
  FrameFormat format = FrameFormat::kExrHalf;  // of the files of frames
  PictureOptions picture = {};                 // how these files show the frames
  // Path of an mp4 of the frames to write. Must be unset for a shard.
  std::optional<std::filesystem::path> video = {};
  bool contact_sheet = true;  // true: writes contact_sheet.png beside the frames
  // True: writes frame_0001.plate, ... beside the frames. Must be false with kRebin or a shard.
  bool keep_plates = false;

  // Interval between checkpoints, which save the rays of unfinished frames, in seconds; 0:
  // checkpoints are written only when a signal requests one. The interval is extended if
  // checkpoints would take more than 5 % of the time.
  double dump_every_s = 30;
  bool resume = false;     // true: continues from the state in the folder
  bool overwrite = false;  // true: removes the state in the folder
  // Frames to finish at once, with the rays that the state in the folder already has of each. The
  // report of such a frame says at which rank of the order it ended. A frame without rays in the
  // state is rendered as usual. Needs `resume`; must be empty for a shard.
  std::vector<FrameId> finish_early = {};  // ascending
  // Version of the program, for the metadata of the files. RenderFilm() sets it.
  std::string version = {};
  // Called when the files of all frames are complete, before the state is removed; may be empty. If
  // it returns an error, the render ends with it, and a resumed render keeps the frames and calls
  // it again.
  std::function<Result<void>()> complete = {};
};

// How far a render is.
struct RenderProgress {
  size_t frame_count = 0;  // number of finished frames
  size_t frame_total = 0;
  uint64_t ray_count = 0;  // number of rays tested so far; ray_total is an estimate
  uint64_t ray_total = 0;
  // LF images read so far, sum of all passes and packages; image_total is an estimate.
  size_t image_count = 0;
  size_t image_total = 0;
};

}  // namespace lf
