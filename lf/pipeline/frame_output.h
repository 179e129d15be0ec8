// From a frame's plate to its picture, and from these to contact sheet and video. Internal to
// pipeline.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/radiance.h"
#include "lf/collector/frame_lens.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/path/camera_path.h"
#include "lf/pipeline/render.h"
#include "lf/plate/sensor_plate.h"
#include "lf/record/frame_sheet.h"
#include "lf/record/report.h"
#include "lf/sequence/frame_file.h"

namespace lf {

// What a picture of the frame is made by. Its estimator, version, fps and smooth_below are left to
// the caller.
FrameSheet MakeFrameSheet(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                          const FrameLens& lens, const RadianceEncoding& encoding);

// Develops the plate and writes its picture under any name. Its report lacks the samples.
//   completion      what rebinned rays say of it, or null
//   is_interrupted  asked all the time, by any thread, if given
// kOutput: the disk. kInterrupted: nothing is written.
Result<FrameReport> WritePicture(const FrameSheet& sheet, const SensorPlate& plate,
                                 const Completion* completion, const std::filesystem::path& to,
                                 FrameFormat format, ThreadPool& pool,
                                 const std::function<bool()>& is_interrupted);

inline constexpr const char* kContactSheet = "contact_sheet.png";

// A film whose frames are files, so that it does not matter when and by whom they were rendered.
struct FilmFiles {
  std::filesystem::path folder;
  FrameFormat format = FrameFormat::kExrHalf;
  int width_px = 0;
  int height_px = 0;
  double fps = 0;
  const std::atomic<bool>* stop = nullptr;  // ends it, if given

  //   at_once  files that are read at the same time
  // kOutput: the disk, ffmpeg; kInput: a frame that cannot be read, or of another size.
  // kInterrupted.
  Result<void> WriteContactSheet(const std::vector<FrameId>& frames, size_t at_once,
                                 ThreadPool& pool, const std::string& name = kContactSheet) const;
  Result<void> WriteVideo(const std::vector<FrameId>& frames,
                          const std::filesystem::path& video) const;

 private:
  std::filesystem::path PathOf(FrameId frame) const;
  Result<Image<uint8_t>> ReadPicture(FrameId frame) const;
};

// Of the frames that a render of the path writes: all have the same size.
FilmFiles FilesOfFilm(const CameraPath& path, const RenderOptions& options);

}  // namespace lf
