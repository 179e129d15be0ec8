// SPDX-License-Identifier: Apache-2.0
// Renders a package, that is a light field and a camera path (render/package/package.h), as an
// image sequence into a folder (thesis 4.3). film_renderer.h renders in memory.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/frame_file.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"
#include "lf/render/state/report.h"

namespace lf {

// Requests to a render in progress. Code that sets `stop` or `save` must set `attention`
// afterwards. Signal handlers may set all three.
struct RenderSignals {
  std::atomic<bool> attention = false;  // true: the work pauses soon, to read `stop` and `save`
  std::atomic<bool> stop = false;       // true: the state is written, and the render ends
  std::atomic<bool> save = false;       // true: the state is written, and the render continues
};

// The folder that the frames and the state of a render go into.
struct FolderOptions {
  std::filesystem::path output_folder;
  // Files other than LF images that the program reads, such as the calibration and the path. No
  // output may replace them.
  std::vector<std::filesystem::path> inputs;
  // Files that `complete` writes, and that no other output may be.
  std::vector<std::filesystem::path> more_outputs = {};
  FrameFormat format = FrameFormat::kExrHalf;
  PictureOptions picture;
  // Path of an mp4 of the frames to write. Must be unset for a shard.
  std::optional<std::filesystem::path> video;
  bool contact_sheet = true;  // true: writes contact_sheet.png beside the frames
  // True: writes frame_0001.plate, ... beside the frames. Must be false with kRebin or a shard.
  bool keep_plates = false;

  // Interval between checkpoints (run_state.h), in seconds; 0: checkpoints are written only when a
  // signal requests one. The interval is extended if checkpoints would take more than 5 % of the
  // time.
  double dump_every_s = 30;
  bool resume = false;     // true: continues from the state in the folder
  bool overwrite = false;  // true: removes the state in the folder
  // Frames to finish at once, with the rays that the state in the folder already has of each. The
  // report of such a frame says at which place of the order it ended. A frame without rays in the
  // state is rendered as usual. Needs `resume`; must be empty for a shard.
  std::vector<FrameId> finish_early;  // ascending
  std::string version;                // version of the program, for the metadata of the files
  // Called when the files of all frames are complete, before the state is removed; may be empty. If
  // it returns an error, the render ends with it, and a resumed render keeps the frames and calls
  // it again.
  std::function<Result<void>()> complete = {};
};

// If FilmSettings::shard is set, the render writes plates for MergeShards() instead of frames and a
// contact sheet.
struct RenderOptions {
  std::vector<FrameId> frames;       // some frames of the package, ascending; empty: all
  FilmSettings film;                 // what the frames are made of
  WorkSettings work;                 // how the work is done; `signals` replaces its flags
  FolderOptions folder;              // where the frames are written
  RenderSignals* signals = nullptr;  // requests to this render, read often; may be null
};

struct RenderProgress {
  size_t frame_count = 0;  // number of finished frames
  size_t frame_total = 0;
  uint64_t ray_count = 0;  // number of rays tested so far; ray_total is an estimate
  uint64_t ray_total = 0;
  // LF images read so far, sum of all passes and packages; image_total is an estimate.
  size_t image_count = 0;
  size_t image_total = 0;
};

// Checks the options of the film (CheckFilmSettings()) and of the folder. Render() calls this
// before it starts; a program may call it before a job waits in a queue. kUsage: the options are
// not compatible; an output would replace a file that the render reads; the lens of a frame is a
// pinhole, but lens weights by area need its area.
Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options);

// Returns a whole light field and a path as one package for these options: with the order, the seed
// and the largest angle of FilmSettings.
// kUsage: the options are not compatible (CheckRenderOptions()). kInterrupted: RenderSignals::stop
// or WorkSettings::stop is set.
Result<Package> PackageOfFilm(LightField light_field, CameraPath path, const RenderOptions& options,
                              ThreadPool& pool);

// Renders the frames into output_folder: frame_0001.exr ..., contact_sheet.png, report.json, and
// the video. A package with a name has the report report-NAME.json and its own state, so that
// several packages may be rendered into one folder at the same time. A file appears under its final
// name only when it is whole. The bits of the frames depend neither on the number of threads, nor
// on the memory (with one exception, see WorkSettings), nor on how often the render was
// interrupted, killed and resumed. A kill loses at most the work since the last checkpoint.
//   kUsage        the options are not compatible; the folder has an unfinished render, and neither
//                 FolderOptions::resume nor overwrite is set; resume is set, but the state has
//                 other inputs; a report of another package or shard there has other inputs
//                 (run_state.h)
//   kInput        no LF image contributes to any frame, or no frame gets a ray (both only if the
//                 package has no name and there is no shard); broken LF images (collect.h); a
//                 damaged state; the packed store lacks pixels (FilmSetup::Make())
//   kOutput       the disk or the memory does not suffice: the state on the disk is that of the
//                 last checkpoint; or ffmpeg is missing, or failed after the frames were written
//   kInterrupted  finished frames are kept, and the state of the others is written
Result<RenderReport> Render(Package package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
