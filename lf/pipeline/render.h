// The main job: a package in, an image sequence out (thesis 4.3). A light field and a camera path
// are a package, too (package/package.h).
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

// What the user wants of a render under way. Whoever sets `stop` or `save` then sets `attention`;
// handlers of signals may.
struct RenderSignals {
  std::atomic<bool> attention = false;  // ends what is being done, so that the others are looked at
  std::atomic<bool> stop = false;       // write the state and end
  std::atomic<bool> save = false;       // write the state and go on
};

struct RenderOptions {
  std::filesystem::path output_folder;
  // Files beside LF images that are read, and that no output may replace: calibration, path.
  std::vector<std::filesystem::path> inputs;
  std::vector<FrameId> frames;  // ascending, of the package; empty: all of it
  FrameFormat format = FrameFormat::kExrHalf;
  std::optional<std::filesystem::path> video;  // an mp4 of the frames
  bool contact_sheet = true;                   // contact_sheet.png beside the frames
  bool keep_plates = false;                    // frame_0001.plate beside the frames

  // Plates of some of the LF images alone, for MergeShards(): no frames, contact sheet or video.
  // Not with rules that count rays, with rebinned rays or with keep_plates.
  std::optional<Shard> shard;
  // off: a frame takes only the first so many LF images of the order that contribute to it. No more
  // than the package was made for.
  std::optional<size_t> max_image_count;
  // off: a frame is finished when its elements have so many rays (sample_rule.h). Decided where a
  // multiple of 64 places of the order is done (of 128, 256, ... where a frame takes only a part of
  // them), so that the frame has the same bits in any run.
  std::optional<uint32_t> stop_at_samples;
  std::optional<uint32_t> require_samples;  // off: measured, and in the report of each frame
  // off: a frame is finished when its noise is no more than this (noise_rule.h), in linear radiance
  // with the light field's white as 1. Decided at the places of NoiseDecisionAfter(). For every
  // mode, estimator, filter and weights: with kRebin frames collect what noise is measured by, and
  // their pictures do without. Not with shard.
  std::optional<double> stop_at_noise;
  std::optional<double> require_noise;  // off: measured, and in the report of each frame
  uint32_t smooth_below = 0;            // this and the next: sequence/develop.h
  int fill_radius_px = kFillRadius_px;
  size_t memory_bytes = size_t{8} << 30;
  bool strict = false;
  bool whole_images = false;  // SelectOptions; the same bits, but slower
  // With kBilinear the light field wants MakeRoomForUndershoot() (capture/radiance.h). Not kMosaic
  // where CountsRays(), for its rays count more than once.
  RayReading reading;
  // kNone where CountsRays(), for counts are sums of weights else; and of a package without
  // neighbours.
  LensWeights lens_weights = LensWeights::kNone;
  CollectBackEnd back_end = CollectBackEnd::kFast;
  RenderMode mode = RenderMode::kCollect;
  // Not where kCollect. max_cells 0: as many as fit in half of the memory with kRebin, or a quarter
  // with kHybrid.
  RebinPassOptions rebin;

  // Checkpoints (run_state.h). They take at most 5 % of the time: the interval stretches itself.
  double dump_every_s = 30;  // 0: none but those asked for by signals
  bool resume = false;       // go on with the state in the folder
  bool overwrite = false;    // remove it
  // Those of these frames that the state has rays of are finished at once, with these: their
  // reports say before which place of the order. With resume; not with shard.
  std::vector<FrameId> finish_early;  // ascending

  std::string version;               // of the program, for the files' metadata
  RenderSignals* signals = nullptr;  // looked at all the time

  // Whether something asks how many rays elements have.
  bool CountsRays() const { return stop_at_samples || require_samples || smooth_below > 0; }
  // Returns true if some option asks how much LF images differ in elements.
  bool MeasuresNoise() const { return stop_at_noise || require_noise; }
};

struct RenderProgress {
  size_t frame_count = 0;  // finished, and in all
  size_t frame_total = 0;
  uint64_t ray_count = 0;  // tested, and an estimate of all
  uint64_t ray_total = 0;
  size_t image_count = 0;  // LF images read, and to be read in all passes
  size_t image_total = 0;
};

// Returns the options that decide which LF images frames of the package need
// (preprocess/frame_needs.h).
NeedsOptions NeedsOfRender(const Package& package, const RenderOptions& options);

// Gives the LF images of a whole light field the order for the film and the options.
// kUsage: options that cannot be together. kInterrupted.
Result<void> PutInOrder(ImageOrder order, const RenderOptions& options, ThreadPool& pool,
                        Package* package);

// Renders the frames into output_folder: frame_0001.exr ..., contact_sheet.png, report.json, and
// the video. Of a package that has a name, the report is report-NAME.json and the state its own, so
// that several may be rendered into one folder at the same time. Every file appears under its name
// only when it is whole. The frames have the same bits for any number of threads and any memory,
// and however often the render was interrupted, killed and resumed: at most the time since the last
// checkpoint is lost.
//   kUsage        an unfinished render in the folder, or one from other inputs (run_state.h)
//   kInput        no LF image contributes to any frame, or none has a ray; broken images
//                 (collect.h); a damaged state
//   kOutput       disk, memory; ffmpeg, after the frames are written all the same. The state on the
//                 disk is that of the last checkpoint.
//   kInterrupted  what is finished stays, and the state of what is not is written
Result<RenderReport> Render(const Package& package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
