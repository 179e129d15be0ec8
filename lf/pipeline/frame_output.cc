#include "lf/pipeline/frame_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "lf/capture/lf_pixels.h"
#include "lf/pipeline/frame_metadata.h"
#include "lf/record/run_inputs.h"
#include "lf/sequence/contact_sheet.h"
#include "lf/sequence/frame_file.h"
#include "lf/sequence/video.h"

namespace lf {
namespace {

bool IsExr(FrameFormat format) {
  return format == FrameFormat::kExrHalf || format == FrameFormat::kExrFloat;
}

// Returns the median of the values above 0; 0 if there are none.
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

FrameSheet MakeFrameSheet(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                          const FrameLens& lens, const RadianceEncoding& encoding) {
  FrameSheet sheet;
  sheet.frame = frame;
  sheet.camera = camera;
  sheet.rays = rays;
  sheet.develop.pedestal = encoding.pedestal;
  sheet.develop.scale = encoding.Scale();
  sheet.develop.white_balance = encoding.white_balance;
  sheet.develop.camera_to_srgb = encoding.camera_to_srgb;
  if (const std::optional<FrameLens::Facts> facts = lens.facts())
    sheet.weighed = FrameSheet::Weighed{facts->hat_share, facts->coverage, lens.EffectiveCounts()};
  return sheet;
}

namespace {

ImageMetadata MetadataOf(const FrameSheet& sheet) {
  ImageMetadata metadata = FrameMetadata(sheet.frame, sheet.camera, sheet.rays, sheet.estimator,
                                         sheet.fps, sheet.version);
  if (sheet.places_done)
    metadata.emplace_back("lf:finished_early_before_place", static_cast<int>(*sheet.places_done));
  return metadata;
}

}  // namespace

Result<FrameReport> WritePicture(const FrameSheet& sheet, const SensorPlate& plate,
                                 const Completion* completion, const std::filesystem::path& to,
                                 FrameFormat format, ThreadPool& pool,
                                 const std::function<bool()>& is_interrupted) {
  const auto start = std::chrono::steady_clock::now();
  DevelopOptions develop = sheet.develop;
  develop.is_interrupted = is_interrupted;
  develop.completion = completion;
  develop.transparent = LfPixels::kTransparent;
  develop.opaque = LfPixels::kOpaque;
  DevelopedFrame developed = Develop(plate, develop, pool);
  if (is_interrupted && is_interrupted())
    return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", to.string())};
  FrameReport report = MakeFrameReport(sheet.frame, sheet.rays, developed);
  report.camera = InputsOfCamera(sheet.frame, sheet.camera);
  report.places_done = sheet.places_done;
  if (sheet.weighed) {
    const Image<float>& counts = sheet.weighed->effective_counts;
    report.weighed = {MedianOfSeen(counts.pixels()), sheet.weighed->hat_share,
                      sheet.weighed->coverage};
    if (IsExr(format))
      developed.effective_count = SpreadOverPlate(counts, sheet.camera.pinhole.intrinsics);
  }
  report.develop_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  LF_RETURN_IF_ERROR(WriteFrame(to, developed, format, MetadataOf(sheet), is_interrupted));
  return report;
}

FilmFiles FilesOfFilm(const CameraPath& path, const RenderOptions& options) {
  const Intrinsics& plate = path.Camera(FrameId{1}).pinhole.intrinsics;
  return {options.output_folder,
          options.format,
          plate.width_px,
          plate.height_px,
          path.fps,
          options.signals == nullptr ? nullptr : &options.signals->stop};
}

std::filesystem::path FilmFiles::PathOf(FrameId frame) const {
  return FramePath(folder, frame, format);
}

Result<Image<uint8_t>> FilmFiles::ReadPicture(FrameId frame) const {
  LF_ASSIGN_OR_RETURN(Image<uint8_t> picture, ReadDisplayImage(PathOf(frame)));
  if (picture.width() != width_px || picture.height() != height_px)
    return InputError(fmt::format(
        "{}: has {} x {} pixels, the frame has {} x {}: remove it, and "
        "--resume renders it again",
        PathOf(frame).string(), picture.width(), picture.height(), width_px, height_px));
  return picture;
}

Result<void> FilmFiles::WriteContactSheet(const std::vector<FrameId>& frames, size_t at_once,
                                          ThreadPool& pool, const std::string& name) const {
  const std::vector<size_t> shown = ContactSheetFrames(frames.size());
  ContactSheet sheet(shown.size(), width_px, height_px);
  for (size_t begin = 0; begin < shown.size(); begin += at_once) {
    if (stop != nullptr && *stop)
      return Error{ErrorKind::kInterrupted, "interrupted at the contact sheet"};
    std::vector<std::optional<Error>> errors(std::min(at_once, shown.size() - begin));
    pool.ForEach(errors.size(), [&](size_t i) {
      if (const auto picture = ReadPicture(frames[shown[begin + i]]); picture)
        sheet.Place(begin + i, *picture);
      else
        errors[i] = picture.error();
    });
    for (const std::optional<Error>& error : errors)
      if (error) return *error;
  }
  return sheet.Write(folder / name);
}

Result<void> FilmFiles::WriteVideo(const std::vector<FrameId>& frames,
                                   const std::filesystem::path& video) const {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<VideoWriter> writer,
                      VideoWriter::Open(video, width_px, height_px, fps));
  for (const FrameId frame : frames) {
    if (stop != nullptr && *stop) return Error{ErrorKind::kInterrupted, "interrupted at the video"};
    LF_ASSIGN_OR_RETURN(const Image<uint8_t> picture, ReadPicture(frame));
    LF_RETURN_IF_ERROR(writer->Add(picture));
  }
  return writer->Close();
}

}  // namespace lf
