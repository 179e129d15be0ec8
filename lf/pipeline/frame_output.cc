#include "lf/pipeline/frame_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>

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

bool IsExr(FrameFormat format) {
  return format == FrameFormat::kExrHalf || format == FrameFormat::kExrFloat;
}

// Of those that are not 0; 0 if all are.
double MedianOfSeen(const LargeVector<float>& values) {
  std::vector<float> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](float value) { return value > 0; });
  if (sorted.empty()) return 0;
  const auto middle = sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace

Result<void> CheckVideoTarget(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  // The folder of the frames is made if it is missing, another is not.
  if (!std::filesystem::is_directory(folder, error))
    return OutputError(
        fmt::format("--video {}: there is no folder {}", path.string(), folder.string()));
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    return OutputError(fmt::format("--video {}: exists and is no file", path.string()));
  return {};
}

std::filesystem::path FrameOutput::PathOf(FrameId frame) const {
  return FramePath(options_.output_folder, frame, options_.format);
}

Result<FrameReport> FrameOutput::Write(FrameId frame, const FrameRays& rays, const FrameLens& lens,
                                       const SensorPlate& plate, const Completion* completion,
                                       const std::filesystem::path& to,
                                       const std::function<bool()>& is_interrupted) const {
  const auto start = std::chrono::steady_clock::now();
  const RenderCamera& camera = path_.Camera(frame);
  DevelopOptions develop = DevelopOptionsFor(light_field_.encoding, options_.smooth_below);
  develop.is_interrupted = is_interrupted;
  develop.completion = completion;
  DevelopedFrame developed = Develop(plate, develop, pool_);
  if (is_interrupted && is_interrupted())
    return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", to.string())};
  FrameReport report = MakeFrameReport(frame, rays, developed);
  report.camera = InputsOfCamera(frame, camera);
  if (const std::optional<FrameLens::Facts> facts = lens.facts()) {
    const Image<float> counts = lens.EffectiveCounts();
    report.weighed = {MedianOfSeen(counts.pixels()), facts->hat_share, facts->uncovered_share};
    if (IsExr(options_.format)) developed.effective_count = lens.SpreadOverPlate(counts);
  }
  report.develop_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  LF_RETURN_IF_ERROR(WriteFrame(
      to, developed, options_.format,
      FrameMetadata(frame, camera, rays, options_.reading.estimator, path_.fps, options_.version),
      is_interrupted));
  return report;
}

Result<Image<uint8_t>> FrameOutput::ReadPicture(FrameId frame) const {
  LF_ASSIGN_OR_RETURN(Image<uint8_t> picture, ReadDisplayImage(PathOf(frame)));
  const Intrinsics& plate = path_.Camera(frame).pinhole.intrinsics;
  if (picture.width() != plate.width_px || picture.height() != plate.height_px)
    return InputError(
        fmt::format("{}: has {} x {} pixels, the frame has {} x {}: remove it, and "
                    "--resume renders it again",
                    PathOf(frame).string(), picture.width(), picture.height(), plate.width_px,
                    plate.height_px));
  return picture;
}

Result<void> FrameOutput::WriteContactSheet(const std::vector<FrameId>& frames, size_t at_once,
                                            const std::string& name) const {
  const std::vector<size_t> shown = ContactSheetFrames(frames.size());
  const Intrinsics& plate = path_.Camera(frames.front()).pinhole.intrinsics;
  ContactSheet sheet(shown.size(), plate.width_px, plate.height_px);
  for (size_t begin = 0; begin < shown.size(); begin += at_once) {
    if (options_.signals != nullptr && options_.signals->stop)
      return Error{ErrorKind::kInterrupted, "interrupted at the contact sheet"};
    std::vector<std::optional<Error>> errors(std::min(at_once, shown.size() - begin));
    pool_.ForEach(errors.size(), [&](size_t i) {
      if (const auto picture = ReadPicture(frames[shown[begin + i]]); picture)
        sheet.Place(begin + i, *picture);
      else
        errors[i] = picture.error();
    });
    for (const std::optional<Error>& error : errors)
      if (error) return *error;
  }
  return sheet.Write(options_.output_folder / name);
}

Result<void> FrameOutput::WriteVideo(const std::vector<FrameId>& frames) const {
  const Intrinsics& plate = path_.Camera(frames.front()).pinhole.intrinsics;
  LF_ASSIGN_OR_RETURN(
      const std::unique_ptr<VideoWriter> video,
      VideoWriter::Open(*options_.video, plate.width_px, plate.height_px, path_.fps));
  for (const FrameId frame : frames) {
    if (options_.signals != nullptr && options_.signals->stop)
      return Error{ErrorKind::kInterrupted, "interrupted at the video"};
    LF_ASSIGN_OR_RETURN(const Image<uint8_t> picture, ReadPicture(frame));
    LF_RETURN_IF_ERROR(video->Add(picture));
  }
  return video->Close();
}

}  // namespace lf
