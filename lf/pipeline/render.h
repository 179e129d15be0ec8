// The main job: a light field and a camera path in, an image sequence out (thesis 4.3).
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/path/camera_path.h"
#include "lf/pipeline/collect.h"
#include "lf/pipeline/report.h"
#include "lf/sequence/frame_file.h"

namespace lf {

struct RenderOptions {
  std::filesystem::path output_folder;
  std::vector<FrameId> frames;  // ascending; empty: all of the path
  FrameFormat format = FrameFormat::kExrHalf;
  std::optional<std::filesystem::path> video;  // an mp4 of the frames
  bool contact_sheet = true;                   // contact_sheet.png beside the frames

  std::optional<size_t> max_image_count;  // off: the first so many LF images of the order
  uint32_t smooth_below = 0;              // sequence/develop.h
  size_t memory_bytes = size_t{8} << 30;
  uint64_t seed = 0;
  bool strict = false;
  Estimator estimator = Estimator::kNearest;
  CollectBackEnd back_end = CollectBackEnd::kFast;

  std::string version;                             // of the program, for the files' metadata
  const std::atomic<bool>* interrupted = nullptr;  // becomes true when the user wants to stop
};

struct RenderProgress {
  size_t frame_count = 0;  // finished, and in all
  size_t frame_total = 0;
  uint64_t ray_count = 0;  // tested, and an estimate of all
  uint64_t ray_total = 0;
  size_t image_count = 0;  // LF images read, and to be read in all passes
  size_t image_total = 0;
};

// Renders the frames into output_folder: frame_0001.exr ..., contact_sheet.png, report.json, and
// the video. Every file appears under its name only when it is whole. The frames have the same
// bits for any number of threads and any memory.
//   kUsage        bilinear for mosaics
//   kInput        no LF image contributes to any frame, or none has a ray; broken images
//                 (collect.h)
//   kOutput       disk, memory; ffmpeg, after the frames are written all the same
//   kInterrupted  what is finished stays
Result<RenderReport> Render(const LightField& light_field, const CameraPath& path,
                            const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress);

}  // namespace lf
