// From a frame's plate to its files. Internal to pipeline.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/collector/frame_lens.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/path/camera_path.h"
#include "lf/pipeline/render.h"
#include "lf/plate/sensor_plate.h"
#include "lf/record/report.h"

namespace lf {

// Of --video, before the work and not after it: kOutput where the file could not be written.
Result<void> CheckVideoTarget(const std::filesystem::path& path);

inline constexpr const char* kContactSheet = "contact_sheet.png";

// The light field, path and options must outlive it.
class FrameOutput {
 public:
  FrameOutput(const LightField& light_field, const CameraPath& path, const RenderOptions& options,
              ThreadPool& pool)
      : light_field_(light_field), path_(path), options_(options), pool_(pool) {}

  // Develops the plate and writes its picture under any name. Its report lacks the samples.
  //   completion      what rebinned rays say of it, or null
  //   is_interrupted  asked all the time, by any thread, if given
  // kOutput: the disk. kInterrupted: nothing is written.
  Result<FrameReport> Write(FrameId frame, const FrameRays& rays, const FrameLens& lens,
                            const SensorPlate& plate, const Completion* completion,
                            const std::filesystem::path& to,
                            const std::function<bool()>& is_interrupted) const;

  // From the files of the frames, so that it does not matter when and by whom they were rendered.
  //   at_once  files that are read at the same time
  // kOutput: the disk, ffmpeg; kInput: a frame that cannot be read, or of another size.
  // kInterrupted.
  Result<void> WriteContactSheet(const std::vector<FrameId>& frames, size_t at_once,
                                 const std::string& name = kContactSheet) const;
  Result<void> WriteVideo(const std::vector<FrameId>& frames) const;

 private:
  std::filesystem::path PathOf(FrameId frame) const;
  Result<Image<uint8_t>> ReadPicture(FrameId frame) const;

  const LightField& light_field_;
  const CameraPath& path_;
  const RenderOptions& options_;
  ThreadPool& pool_;
};

}  // namespace lf
