// The main task: renders a package into an image sequence (thesis 4.3). A light field and a camera
// path form a package (package/package.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/collector/collect.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/hybrid/rebinned_rays.h"
#include "lf/hybrid/render_mode.h"
#include "lf/lens_weights/frame_weights.h"
#include "lf/package/package.h"
#include "lf/preprocess/frame_needs.h"
#include "lf/record/report.h"
#include "lf/record/shard.h"
#include "lf/sequence/develop.h"
#include "lf/sequence/frame_file.h"

namespace lf {

// Requests to a render in progress. Code that sets `stop` or `save` must then set `attention`;
// signal handlers may set them.
struct RenderSignals {
  std::atomic<bool> attention = false;  // interrupts the current step, so that the others are read
  std::atomic<bool> stop = false;       // write the state and end
  std::atomic<bool> save = false;       // write the state and continue
};

struct RenderOptions {
  std::filesystem::path output_folder;
  // Files other than LF images that are read, which no output may replace: calibration, path.
  std::vector<std::filesystem::path> inputs;
  std::vector<FrameId> frames;  // of the package, ascending; empty: all of its frames
  FrameFormat format = FrameFormat::kExrHalf;
  std::optional<std::filesystem::path> video;  // an mp4 of the frames
  bool contact_sheet = true;                   // contact_sheet.png beside the frames
  bool keep_plates = false;                    // frame_0001.plate beside the frames

  // If set, writes plates of a part of the LF images for MergeShards(), and no frames, contact
  // sheet or video. Not with rules that count rays or measure noise, with rebinned rays, with
  // keep_plates or with a video.
  std::optional<Shard> shard;
  // If set, a frame takes only the first so many LF images of the order that contribute to it. Must
  // not be more than the package was made for.
  std::optional<size_t> max_image_count;
  // If set, a frame is finished when its elements have so many rays (sample_rule.h). This is
  // decided after multiples of 64 places of the order (of 128, 256, ... if a frame takes only a
  // part of the LF images), so that the frame has the same bits in any run.
  std::optional<uint32_t> stop_at_samples;
  std::optional<uint32_t> require_samples;  // if set, measured for the report of each frame
  // If set, a frame is finished when its noise is at most this (noise_rule.h), in linear radiance
  // with the light field's white as 1. This is decided at the places of NoiseDecisionAfter(). Works
  // with every mode, estimator, filter and weights: with kRebin, frames collect rays to measure the
  // noise, but their pictures do not use them. Not with shard.
  std::optional<double> stop_at_noise;
  std::optional<double> require_noise;  // if set, measured for the report of each frame
  uint32_t smooth_below = 0;            // this and fill_radius_px: sequence/develop.h
  int fill_radius_px = kFillRadius_px;
  size_t memory_bytes = size_t{8} << 30;
  bool strict = false;        // a broken LF image is an error, and not skipped
  bool whole_images = false;  // SelectOptions::whole_images: the same bits, but slower
  // With kBilinear, call MakeRoomForUndershoot() for the light field (capture/radiance.h). Must not
  // be kMosaic if CountsRays() is true, because its rays count more than once.
  RayReading reading;
  // Must be kNone if CountsRays() is true, because weighted counts are not ray counts, and if the
  // package has no neighbours.
  LensWeights lens_weights = LensWeights::kNone;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  RenderMode mode = RenderMode::kCollect;
  // Unused with kCollect. If max_cells is 0, as many cells as fit in half of the memory with
  // kRebin, or in a quarter with kHybrid.
  RebinPassOptions rebin;

  // Interval between checkpoints (run_state.h); 0: only those that signals ask for. Checkpoints
  // take at most 5 % of the time: the interval is extended if they would take more.
  double dump_every_s = 30;
  bool resume = false;     // continue with the state in the folder
  bool overwrite = false;  // remove the state in the folder
  // Frames to finish at once with the rays that the state has of them. Their reports name the place
  // of the order at which they ended. Frames without rays are rendered as usual. Only with resume,
  // and not with shard.
  std::vector<FrameId> finish_early;  // ascending

  std::string version;               // of the program, for the files' metadata
  RenderSignals* signals = nullptr;  // read often; may be null

  // Returns true if an option depends on the number of rays of elements.
  bool CountsRays() const { return stop_at_samples || require_samples || smooth_below > 0; }
  // Returns true if an option depends on the differences between LF images in elements.
  bool MeasuresNoise() const { return stop_at_noise || require_noise; }
};

struct RenderProgress {
  size_t frame_count = 0;  // finished, and in all
  size_t frame_total = 0;
  uint64_t ray_count = 0;  // tested, and estimated in all
  uint64_t ray_total = 0;
  size_t image_count = 0;  // LF images read, and to be read in all passes
  size_t image_total = 0;
};

// Returns the options that decide which LF images frames of the package need
// (preprocess/frame_needs.h).
NeedsOptions NeedsOfRender(const Package& package, const RenderOptions& options);

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
Result<RenderReport> Render(const Package& package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
