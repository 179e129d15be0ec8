#include "lf/pipeline/frame_output.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "lf/pipeline/frame_metadata.h"
#include "lf/record/run_inputs.h"
#include "lf/sequence/contact_sheet.h"
#include "lf/sequence/frame_file.h"
#include "lf/sequence/video.h"

namespace lf {
namespace {

DevelopOptions DevelopOptionsFor(const RadianceEncoding& encoding, uint32_t smooth_below) {
  DevelopOptions options;
  options.pedestal = encoding.pedestal;
  options.scale = encoding.Scale();
  options.white_balance = encoding.white_balance;
  options.camera_to_srgb = encoding.camera_to_srgb;
  options.smooth_below = smooth_below;
  return options;
}

}  // namespace

std::filesystem::path FrameOutput::PathOf(FrameId frame) const {
  return FramePath(options_.output_folder, frame, options_.format);
}

Result<FrameReport> FrameOutput::Write(FrameId frame, const FrameRays& rays,
                                       const SensorPlate& plate, const std::filesystem::path& to,
                                       const std::function<bool()>& is_interrupted) const {
  const auto start = std::chrono::steady_clock::now();
  const RenderCamera& camera = path_.Camera(frame);
  DevelopOptions develop = DevelopOptionsFor(light_field_.encoding, options_.smooth_below);
  develop.is_interrupted = is_interrupted;
  const DevelopedFrame developed = Develop(plate, develop, pool_);
  if (is_interrupted && is_interrupted())
    return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", to.string())};
  FrameReport report = MakeFrameReport(frame, rays, developed);
  report.camera = InputsOfCamera(frame, camera);
  report.develop_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  LF_RETURN_IF_ERROR(WriteFrame(
      to, developed, options_.format,
      FrameMetadata(frame, camera, rays, options_.estimator, path_.fps, options_.version),
      is_interrupted));
  return report;
}

Result<void> FrameOutput::WriteContactSheet(const std::vector<FrameId>& frames) const {
  std::vector<Image<uint8_t>> pictures;
  for (const size_t index : ContactSheetFrames(frames.size())) {
    if (options_.signals != nullptr && options_.signals->stop)
      return Error{ErrorKind::kInterrupted, "interrupted at the contact sheet"};
    LF_ASSIGN_OR_RETURN(Image<uint8_t> picture, ReadDisplayImage(PathOf(frames[index])));
    pictures.push_back(std::move(picture));
  }
  return lf::WriteContactSheet(options_.output_folder / "contact_sheet.png", pictures);
}

Result<void> FrameOutput::WriteVideo(const std::vector<FrameId>& frames) const {
  const Intrinsics& plate = path_.Camera(frames.front()).pinhole.intrinsics;
  LF_ASSIGN_OR_RETURN(
      const std::unique_ptr<VideoWriter> video,
      VideoWriter::Open(*options_.video, plate.width_px, plate.height_px, path_.fps));
  for (const FrameId frame : frames) {
    if (options_.signals != nullptr && options_.signals->stop)
      return Error{ErrorKind::kInterrupted, "interrupted at the video"};
    LF_ASSIGN_OR_RETURN(const Image<uint8_t> picture, ReadDisplayImage(PathOf(frame)));
    LF_RETURN_IF_ERROR(video->Add(picture));
  }
  return video->Close();
}

}  // namespace lf
