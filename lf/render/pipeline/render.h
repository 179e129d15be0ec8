// The main task: renders a package into a folder with an image sequence (thesis 4.3). A light field
// and a camera path form a package (render/package/package.h). film_renderer.h renders in memory.
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
#include "lf/render/pipeline/film_options.h"
#include "lf/render/state/report.h"
#include "lf/selection/image_order.h"

namespace lf {

// Requests to a render in progress. Code that sets `stop` or `save` must then set `attention`;
// signal handlers may set them.
struct RenderSignals {
  std::atomic<bool> attention = false;  // interrupts the current step, so that the others are read
  std::atomic<bool> stop = false;       // write the state and end
  std::atomic<bool> save = false;       // write the state and continue
};

// The folder that the frames and the state of a render go into.
struct FolderOptions {
  std::filesystem::path output_folder;
  // Files other than LF images that are read, which no output may replace: calibration, path.
  std::vector<std::filesystem::path> inputs;
  FrameFormat format = FrameFormat::kExrHalf;
  std::optional<std::filesystem::path> video;  // an mp4 of the frames; not with a shard
  bool contact_sheet = true;                   // contact_sheet.png beside the frames
  bool keep_plates = false;  // frame_0001.plate beside the frames; not with kRebin or a shard

  // Interval between checkpoints (run_state.h); 0: only those that signals ask for. Checkpoints
  // take at most 5 % of the time: the interval is extended if they would take more.
  double dump_every_s = 30;
  bool resume = false;     // continue with the state in the folder
  bool overwrite = false;  // remove the state in the folder
  // Frames to finish at once with the rays that the state has of them. Their reports name the place
  // of the order at which they ended. Frames without rays are rendered as usual. Only with resume,
  // and not with a shard.
  std::vector<FrameId> finish_early;  // ascending
  std::string version;                // of the program, for the files' metadata
};

// A shard (FilmOptions::shard) writes plates for MergeShards(), and no frames or contact sheet.
struct RenderOptions {
  std::vector<FrameId> frames;  // of the package, ascending; empty: all of its frames
  FilmOptions film;             // what the frames are made of
  WorkOptions work;             // how; its flags are those of `signals`, and are set by Render()
  FolderOptions folder;         // where they go
  RenderSignals* signals = nullptr;  // read often; may be null
};

struct RenderProgress {
  size_t frame_count = 0;  // finished, and in all
  size_t frame_total = 0;
  uint64_t ray_count = 0;  // tested, and estimated in all
  uint64_t ray_total = 0;
  size_t image_count = 0;  // LF images read, and to be read in all passes
  size_t image_total = 0;
};

// Checks the options before a render, and before a job waits in a queue: CheckFilmOptions(), and
// the options of the folder. Render() calls this before it starts.
// kUsage; kInput if a camera has no lens area and the lens weights need one.
Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options);

// Puts the LF images of a whole light field in the order for the film and the options.
// kUsage: options that do not go together. kInterrupted: a signal asked to stop.
Result<void> PutInOrder(ImageOrder order, const RenderOptions& options, ThreadPool& pool,
                        Package* package);

// Renders the frames into output_folder: frame_0001.exr ..., contact_sheet.png, report.json, and
// the video. A package with a name has the report report-NAME.json and its own state, so that
// several packages may be rendered into one folder at the same time. Every file appears under its
// name only when it is whole. The bits of the frames depend neither on the number of threads, nor
// on the memory, nor on how often the render was interrupted, killed and resumed. A kill loses at
// most the time since the last checkpoint.
//   kUsage        the options do not go together; the folder has an unfinished render, or one from
//                 other inputs (run_state.h)
//   kInput        no LF image contributes to any frame, or none has a ray; broken LF images
//                 (collect.h); a damaged state
//   kOutput       the disk or the memory does not suffice; ffmpeg failed, after the frames were
//                 written. The state on the disk is that of the last checkpoint.
//   kInterrupted  finished frames stay, and the state of the others is written
Result<RenderReport> Render(Package package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
