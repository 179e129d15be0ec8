// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/statistic_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "lf/core/log.h"
#include "lf/film/develop/frame_file.h"
#include "lf/film/develop/video.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/pipeline/setup_inputs.h"
#include "lf/render/state/other_format.h"
#include "lf/render/state/run_inputs.h"
#include "lf/render/state/run_state.h"

namespace lf {
namespace {

double NowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// One film, and the results of its frames.
class FilmMaker {
 public:
  FilmMaker(const CameraPath& path, const StatisticFilmOptions& options, ThreadPool& pool,
            const std::function<void(const StatisticFilmProgress&)>& progress)
      : path_(path),
        options_(options),
        folder_(options.folder),
        pool_(pool),
        progress_(progress),
        frames_(options.frames) {}

  Result<RenderReport> Run(LightField light_field) {
    LF_RETURN_IF_ERROR(Begin(std::move(light_field)));
    for (const FrameId frame : frames_) {
      if (state_->finished().contains(frame)) continue;
      if (IsStopped()) return Interrupted();
      if (const Result<void> made = MakeFrame(frame); !made)
        return made.error().kind == ErrorKind::kInterrupted ? Interrupted() : made.error();
    }
    return End();
  }

 private:
  bool IsStopped() const { return options_.statistic.stop != nullptr && *options_.statistic.stop; }

  RenderOptions AsRenderOptions() const {
    RenderOptions options;
    options.frames = frames_;
    options.folder = folder_;
    return options;
  }

  Result<void> Begin(LightField light_field) {
    if (frames_.empty())
      for (uint32_t frame = 1; frame <= path_.frame_count(); ++frame)
        frames_.push_back(FrameId{frame});
    if (path_.shutter.exists())
      return UsageError(
          "the path has a shutter, whose blur has no share in an order of rays: leave the shutter "
          "out");
    for (const FrameId frame : frames_) LF_RETURN_IF_ERROR(CheckStatisticLens(path_.Camera(frame)));
    const LightFieldIdentity identity = IdentityOf(light_field);
    LF_ASSIGN_OR_RETURN(const std::string pixels, PixelsOf(light_field));
    Package package = PackageOfAll(std::move(light_field), path_, 0);
    LF_RETURN_IF_ERROR(CheckOutputs(package, AsRenderOptions()));
    if (folder_.video) {
      LF_RETURN_IF_ERROR(CheckVideoTool());
      LF_RETURN_IF_ERROR(CheckVideoTarget(*folder_.video));
    }
    LensStatisticOptions statistic = options_.statistic;
    statistic.may_be_black = true;
    Result<StatisticRenderer> opened =
        StatisticRenderer::Open(std::move(package.light_field), statistic);
    if (!opened) return opened.error();
    renderer_.emplace(*std::move(opened));
    return OpenState(identity, pixels);
  }

  Result<void> OpenState(const LightFieldIdentity& identity, const std::string& pixels) {
    const LightField& light_field = renderer_->light_field();
    RunChoices choices;
    choices.pixels = pixels;
    choices.film.reading = renderer_->reading();
    choices.film.lens_weights = LensWeights::kNone;
    choices.film.guard = false;
    choices.film.max_angle_rad = options_.statistic.max_angle_rad;
    choices.format = NameOf(folder_.format);
    choices.film.adds_opacity = options_.statistic.adds_opacity;
    choices.look = folder_.picture;
    RunInputs rays = InputsOfRays(identity, light_field.encoding, choices);
    for (auto& input : InputsOfStatistic(options_.statistic)) rays.push_back(std::move(input));
    const RunStateOptions state = {folder_.output_folder,
                                   "",
                                   frames_,
                                   folder_.format,
                                   folder_.resume,
                                   folder_.overwrite,
                                   std::move(rays),
                                   InputsOfPicture(choices)};
    LF_ASSIGN_OR_RETURN(state_, RunState::Open(state, path_));
    WarnOfOtherFormat(folder_.output_folder, frames_, folder_.format);
    totals_ = state_->earlier();
    // If nothing of the earlier run is kept, the LF images that it skipped are tried again.
    if (state_->finished().empty()) totals_.skipped.clear();
    if (options_.statistic.strict && !totals_.skipped.empty())
      return InputError(fmt::format(
          "{{strict}}: the unfinished render has left out {} LF images, the first: {}; leave out "
          "{{strict}}, or start again with {{overwrite}} instead of {{resume}}",
          totals_.skipped.size(), totals_.skipped.front().reason));
    totals_.inputs = state.rays;
    totals_.inputs.insert(totals_.inputs.end(), state.picture.begin(), state.picture.end());
    const Intrinsics& plate = path_.Camera(frames_.front()).pinhole.intrinsics;
    totals_.version = folder_.version;
    totals_.estimator = Estimator::kBilinear;
    totals_.width = plate.width_px;
    totals_.height = plate.height_px;
    totals_.thread_count = pool_.thread_count();
    totals_.lf_image_count = RecordedCount(light_field);
    totals_.has_masks =
        !light_field.mask_names.empty() || light_field.encoding.alpha == AlphaMeaning::kMask;
    return {};
  }

  Result<void> MakeFrame(FrameId id) {
    StatisticFilmProgress now;
    now.frame_count =
        static_cast<size_t>(std::count_if(frames_.begin(), frames_.end(), [this](FrameId frame) {
          return state_->finished().contains(frame);
        }));
    now.frame_total = frames_.size();
    LF_ASSIGN_OR_RETURN(StatisticFrame frame,
                        renderer_->Make(id, path_.Camera(id), pool_, [&](size_t done, size_t all) {
                          now.image_count = done;
                          now.image_total = all;
                          if (progress_) progress_(now);
                        }));
    frame.notes.fps = path_.fps;
    frame.notes.version = folder_.version;
    LF_RETURN_IF_ERROR(WritePicture(
        frame.notes, std::move(frame.picture), state_->FinishedPath(id), folder_.format,
        folder_.picture, [this] { return IsStopped(); }, StatisticMetadata(options_.statistic)));
    totals_.AddSkipped(frame.skipped);
    totals_.selected_image_count = std::max(totals_.selected_image_count, frame.image_count);
    totals_.pass_count = std::max(totals_.pass_count, frame.part_count);
    RenderReport until_now = totals_;
    until_now.total_s += NowSeconds() - begin_s_;
    // The totals are written first: a record without them would hide LF images that were skipped.
    LF_RETURN_IF_ERROR(state_->SaveTotals(until_now));
    LF_RETURN_IF_ERROR(state_->SaveFinished(frame.report));
    if (frame.report.rays.image_count == 0)
      LogWarning(
          "frame {} is black, because no LF image has a ray for it: widen its aperture, or move "
          "its camera nearer to the LF cameras",
          id.value);
    return {};
  }

  Result<RenderReport> End() {
    const FilmFiles film = Files();
    if (folder_.contact_sheet)
      if (const Result<void> sheet =
              film.WriteContactSheet(frames_, static_cast<size_t>(pool_.thread_count()), pool_);
          !sheet)
        return sheet.error().kind == ErrorKind::kInterrupted ? Interrupted() : sheet.error();
    // An error of the video is returned last, because the frames, which matter more, are finished.
    std::optional<Error> video_error;
    if (folder_.video)
      if (const Result<void> video = film.WriteVideo(frames_, *folder_.video); !video)
        video_error = video.error();
    if (video_error && video_error->kind == ErrorKind::kInterrupted) return Interrupted();
    totals_.frames.clear();
    for (const auto& [frame, report] : state_->finished()) totals_.frames.push_back(report);
    totals_.total_s += NowSeconds() - begin_s_;
    totals_.peak_memory_bytes = PeakMemoryBytes();
    LF_RETURN_IF_ERROR(state_->Close(totals_));
    if (totals_.IsBlack())
      return InputError(fmt::format(
          "{}: all frames are black, because no LF camera has a ray through the lens: open the "
          "aperture (lens.aperture_diameter in the path), or move the camera to the LF cameras",
          folder_.output_folder.string()));
    if (video_error) return *video_error;
    return std::move(totals_);
  }

  FilmFiles Files() const {
    FilmFiles film = FilesOfFilm(path_, AsRenderOptions());
    film.stop = options_.statistic.stop;
    return film;
  }

  Error Interrupted() const { return state_->Interruption(frames_); }

  const CameraPath& path_;
  const StatisticFilmOptions& options_;
  const FolderOptions& folder_;
  ThreadPool& pool_;
  const std::function<void(const StatisticFilmProgress&)>& progress_;
  std::vector<FrameId> frames_;
  std::optional<StatisticRenderer> renderer_;
  std::unique_ptr<RunState> state_;
  RenderReport totals_;
  const double begin_s_ = NowSeconds();
};

}  // namespace

Result<RenderReport> RenderStatisticFilm(
    LightField light_field, const CameraPath& path, const StatisticFilmOptions& options,
    ThreadPool& pool, const std::function<void(const StatisticFilmProgress&)>& progress) {
  return FilmMaker(path, options, pool, progress).Run(std::move(light_field));
}

}  // namespace lf
