#include "lf/pipeline/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <span>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/pipeline/frame_metadata.h"
#include "lf/pipeline/memory_plan.h"
#include "lf/sequence/contact_sheet.h"
#include "lf/sequence/video.h"
#include "lf/store/folder_store.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

DevelopOptions DevelopOptionsFor(const RadianceEncoding& encoding, uint32_t smooth_below) {
  DevelopOptions options;
  options.pedestal = encoding.pedestal;
  options.scale = encoding.Scale();
  options.white_balance = encoding.white_balance;
  options.camera_to_srgb = encoding.camera_to_srgb;
  options.smooth_below = smooth_below;
  return options;
}

// Asked before the work, not after it.
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

// One render: its inputs, and what passes leave behind.
class Renderer {
 public:
  Renderer(const LightField& light_field, const CameraPath& path, const RenderOptions& options,
           ThreadPool& pool, const std::function<void(const RenderProgress&)>& progress)
      : light_field_(light_field),
        path_(path),
        options_(options),
        pool_(pool),
        progress_(progress),
        store_(light_field) {}

  Result<RenderReport> Run();

 private:
  std::vector<SelectedImage> Select(std::span<const FrameId> frames) const;
  Result<void> RunPass(std::span<const FrameId> frames, const std::vector<SelectedImage>& images);
  Result<void> Finish(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                      const SensorPlate& plate);
  void FailVideo(const Result<void>& result);
  void Report(const CollectProgress& pass) const;
  bool OnContactSheet(size_t finished_index) const {
    return std::binary_search(sheet_indices_.begin(), sheet_indices_.end(), finished_index);
  }

  const LightField& light_field_;
  const CameraPath& path_;
  const RenderOptions& options_;
  ThreadPool& pool_;
  const std::function<void(const RenderProgress&)>& progress_;
  FolderStore store_;

  MemoryPlan plan_;
  RenderProgress done_;
  RenderReport report_;
  std::unique_ptr<VideoWriter> video_;
  std::optional<Error> video_error_;
  bool all_broken_ = true;  // every LF image of every pass so far
  std::vector<size_t> sheet_indices_;
  std::vector<Image<uint8_t>> sheet_pictures_;
};

Result<RenderReport> Renderer::Run() {
  const Clock::time_point start = Clock::now();
  if (options_.estimator == Estimator::kBilinear &&
      light_field_.encoding.bayer != BayerPattern::kNone)
    return UsageError(
        "--estimator bilinear interpolates RGB images, and these are mosaics: use nearest");
  std::vector<FrameId> frames = options_.frames;
  if (frames.empty())
    for (uint32_t n = 1; n <= path_.frame_count(); ++n) frames.push_back(FrameId{n});
  const Intrinsics& plate = path_.Camera(frames.front()).pinhole.intrinsics;

  LF_ASSIGN_OR_RETURN(plan_, PlanMemory(options_.memory_bytes, light_field_, plate.width_px,
                                        plate.height_px, frames.size()));
  LF_RETURN_IF_ERROR(CreateFolder(options_.output_folder));
  if (options_.video) {
    LF_RETURN_IF_ERROR(CheckVideoTool());
    LF_RETURN_IF_ERROR(CheckVideoTarget(*options_.video));
  }
  // Of an earlier run: they would look like this one's, should it fail.
  std::error_code ignored;
  std::filesystem::remove(options_.output_folder / "report.json", ignored);
  std::filesystem::remove(options_.output_folder / "contact_sheet.png", ignored);
  if (options_.video) {
    LF_ASSIGN_OR_RETURN(
        video_, VideoWriter::Open(*options_.video, plate.width_px, plate.height_px, path_.fps));
  }
  if (options_.contact_sheet) sheet_indices_ = ContactSheetFrames(frames.size());

  report_.version = options_.version;
  report_.estimator = options_.estimator;
  report_.width = plate.width_px;
  report_.height = plate.height_px;
  report_.thread_count = pool_.thread_count();
  report_.lf_image_count = light_field_.size();
  report_.pass_count = (frames.size() + plan_.frames_per_pass - 1) / plan_.frames_per_pass;
  done_.frame_total = frames.size();
  if (report_.pass_count > 1)
    LogInfo("{} frames in {} passes over the LF images: {} plates of {} MiB fit in the memory",
            frames.size(), report_.pass_count, plan_.frames_per_pass, plan_.plate_bytes >> 20);

  std::vector<SelectedImage> images = Select(frames);
  if (images.empty())
    return InputError(fmt::format(
        "no LF image contributes to frames {}-{}: no recorded ray passes both their lens and what "
        "they see (is the aperture smaller than the camera spacing, or the camera off the "
        "capture?)",
        frames.front().value, frames.back().value));
  for (size_t begin = 0; begin < frames.size(); begin += plan_.frames_per_pass) {
    const size_t count = std::min(plan_.frames_per_pass, frames.size() - begin);
    const std::span<const FrameId> pass = std::span(frames).subspan(begin, count);
    if (report_.pass_count > 1) images = Select(pass);
    LF_RETURN_IF_ERROR(RunPass(pass, images));
  }
  if (video_) FailVideo(video_->Close());
  if (options_.contact_sheet)
    LF_RETURN_IF_ERROR(
        WriteContactSheet(options_.output_folder / "contact_sheet.png", sheet_pictures_));
  report_.total_s = SecondsSince(start);
  report_.peak_memory_bytes = PeakMemoryBytes();
  LF_RETURN_IF_ERROR(WriteReport(report_, options_.output_folder / "report.json"));
  if (report_.AcceptedRays() == 0)
    return InputError(fmt::format(
        "{}: every frame is black: no ray of {} LF images reached them (are the images masked?)",
        options_.output_folder.string(), report_.selected_image_count));
  if (video_error_) return *video_error_;
  return std::move(report_);
}

std::vector<SelectedImage> Renderer::Select(std::span<const FrameId> frames) const {
  std::vector<RenderCamera> cameras;
  for (const FrameId frame : frames) cameras.push_back(path_.Camera(frame));
  std::vector<SelectedImage> images =
      SelectImages(light_field_, cameras, {options_.seed, ReachOf(options_.estimator)}, pool_);
  if (options_.max_image_count && images.size() > *options_.max_image_count)
    images.resize(*options_.max_image_count);
  return images;
}

Result<void> Renderer::RunPass(std::span<const FrameId> frames,
                               const std::vector<SelectedImage>& images) {
  std::vector<RenderCamera> cameras;
  std::vector<SensorPlate> plates;
  for (const FrameId frame : frames) {
    cameras.push_back(path_.Camera(frame));
    plates.emplace_back(report_.width, report_.height);
  }
  report_.selected_image_count = std::max(report_.selected_image_count, images.size());
  // Later passes are guessed to be like this one.
  const size_t passes_left =
      (done_.frame_total - done_.frame_count + frames.size() - 1) / frames.size();
  done_.image_total = done_.image_count + images.size() * passes_left;
  done_.ray_total =
      done_.ray_count + passes_left * std::accumulate(images.begin(), images.end(), uint64_t{0},
                                                      [](uint64_t sum, const SelectedImage& image) {
                                                        return sum + image.ray_count;
                                                      });

  CollectOptions collect;
  collect.estimator = options_.estimator;
  collect.back_end = options_.back_end;
  collect.batch_image_count = static_cast<int>(plan_.batch_image_count);
  collect.strict = options_.strict;
  collect.interrupted = options_.interrupted;
  LF_ASSIGN_OR_RETURN(CollectStatistics statistics,
                      Collect(light_field_, store_, cameras, images, collect, pool_, &plates,
                              [this](const CollectProgress& pass) { Report(pass); }));
  // Passes depend on the memory; what counts as broken must not.
  all_broken_ = all_broken_ && statistics.skipped.size() == images.size();
  const bool is_last = done_.frame_count + frames.size() == done_.frame_total;
  if (all_broken_ && is_last && !statistics.skipped.empty())
    return InputError(
        fmt::format("every LF image is broken; the first: {}", statistics.skipped.front().reason));
  done_.image_count += images.size();
  for (const SelectedImage& image : images) done_.ray_count += image.ray_count;
  report_.load_cpu_s += statistics.times.load_cpu_s;
  report_.load_wall_s += statistics.times.load_wall_s;
  report_.collect_cpu_s += statistics.times.collect_cpu_s;
  for (SkippedImage& skipped : statistics.skipped)
    if (std::none_of(report_.skipped.begin(), report_.skipped.end(),
                     [&](const SkippedImage& known) { return known.name == skipped.name; }))
      report_.skipped.push_back(std::move(skipped));

  for (size_t i = 0; i < frames.size(); ++i) {
    if (options_.interrupted != nullptr && *options_.interrupted)
      return Error{ErrorKind::kInterrupted, fmt::format("interrupted after {} of {} frames",
                                                        done_.frame_count, done_.frame_total)};
    LF_RETURN_IF_ERROR(Finish(frames[i], cameras[i], statistics.frames[i], plates[i]));
    plates[i] = SensorPlate(0, 0);
    Report({});
  }
  return {};
}

Result<void> Renderer::Finish(FrameId frame, const RenderCamera& camera, const FrameRays& rays,
                              const SensorPlate& plate) {
  const Clock::time_point start = Clock::now();
  const DevelopedFrame developed =
      Develop(plate, DevelopOptionsFor(light_field_.encoding, options_.smooth_below), pool_);
  FrameReport report = MakeFrameReport(frame, rays, developed);
  report.develop_s = SecondsSince(start);
  LF_RETURN_IF_ERROR(WriteFrame(
      FramePath(options_.output_folder, frame, options_.format), developed, options_.format,
      FrameMetadata(frame, camera, rays, options_.estimator, path_.fps, options_.version)));
  const bool on_sheet = OnContactSheet(done_.frame_count);
  if (video_ || on_sheet) {
    Image<uint8_t> picture = DisplayImage(developed);
    if (video_) FailVideo(video_->Add(picture));
    if (on_sheet) sheet_pictures_.push_back(std::move(picture));
  }
  if (rays.image_count == 0)
    LogWarning("frame {} is black: no LF image contributes to it", frame.value);
  report_.frames.push_back(report);
  done_.frame_count += 1;
  return {};
}

// The frames are what counts: they are finished, and the video's error comes last.
void Renderer::FailVideo(const Result<void>& result) {
  if (result) return;
  video_error_ = result.error();
  video_.reset();
}

void Renderer::Report(const CollectProgress& pass) const {
  if (!progress_) return;
  RenderProgress now = done_;
  now.image_count += pass.image_count;
  now.ray_count += pass.tested_count;
  progress_(now);
}

}  // namespace

Result<RenderReport> Render(const LightField& light_field, const CameraPath& path,
                            const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress) {
  return Renderer(light_field, path, options, pool, progress).Run();
}

}  // namespace lf
