// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lf/collection/simd_target.h"
#include "lf/core/byte_text.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/film/develop/video.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/pipeline/frame_source.h"
#include "lf/render/pipeline/render_pass.h"
#include "lf/render/pipeline/setup_inputs.h"
#include "lf/render/settings/interpolation.h"
#include "lf/render/state/other_format.h"
#include "lf/render/state/run_inputs.h"
#include "lf/render/state/run_state.h"

namespace lf {

namespace {

RunStateOptions StateOptions(const FilmSetup& setup, const FolderOptions& folder, RunInputs rays) {
  const Package& package = setup.package();
  RunChoices choices;
  choices.film = setup.film();
  choices.format = NameOf(folder.format);
  choices.look = folder.picture;
  RunInputs picture = InputsOfPicture(choices);
  if (!package.name.empty()) picture.emplace_back(kFilmOfPackage, HashOfCameras(package.path));
  return {folder.output_folder, package.name,     package.FrameIds(), folder.format,
          folder.resume,        folder.overwrite, std::move(rays),    std::move(picture),
          setup.film().shard,   setup.frames()};
}

WorkSettings WithFlags(WorkSettings work, const RenderSignals* signals) {
  work.interrupted = signals == nullptr ? nullptr : &signals->attention;
  work.stop = signals == nullptr ? nullptr : &signals->stop;
  return work;
}

// The source of frames that are made of their rays.
class FilmOfRays final : public FilmSource {
 public:
  Result<void> Check(const Package& /*package*/, const RenderOptions& /*options*/) const override {
    return {};
  }
  RunInputs Inputs() const override { return {}; }
  ImageMetadata Metadata() const override { return {}; }
  Result<PassPlan> Plan(FilmSetup* setup, std::span<const FrameId> /*frames*/) override {
    LF_RETURN_IF_ERROR(setup->PlanSlabs());
    const MemoryPlan& plan = setup->plan();
    return PassPlan{
        plan.frames_per_pass, plan.frames_finished_at_once, 1,
        fmt::format("{} plates of {} MiB", plan.frames_per_pass, plan.plate_bytes >> 20)};
  }
  std::unique_ptr<FrameSource> Open(const FilmSetup& setup,
                                    std::span<const FrameId> frames) const override {
    return std::make_unique<FilmRenderer>(setup, frames);
  }
};

// One render: its inputs, and the results of its passes.
class Renderer {
 public:
  Renderer(const RenderOptions& options, ThreadPool& pool,
           const std::function<void(const RenderProgress&)>& progress)
      : options_(options),
        folder_(options.folder),
        source_(options.source != nullptr ? *options.source : rays_),
        pool_(pool),
        progress_(progress) {}

  Result<RenderReport> Run(Package package);

 private:
  // True if neither a package file nor a shard is rendered. The frames must then not all be black.
  bool IsWhole() const { return setup_->package().name.empty() && !setup_->film().shard; }
  bool IsStopped() const { return setup_->work().IsStopped(); }
  Result<void> Begin(Package package);
  Result<void> OpenState();
  void TellPlan() const;
  std::vector<FrameId> FramesToRender();
  Result<void> RunPasses(std::vector<FrameId> frames);
  std::vector<FrameId> EarlyOf(std::span<const FrameId> frames) const;
  Result<void> FinishEarly(const PassContext& context, std::vector<FrameId>* frames);
  Result<void> RunPass(const PassContext& context, std::span<const FrameId> frames,
                       size_t frames_left, std::span<const FrameId> early);
  Result<RenderReport> End();
  Result<void> CheckAnyContributes(std::span<const FrameId> frames) const;
  Error Interrupted() const { return state_->Interruption(setup_->frames()); }
  void Report(const CollectProgress& pass, size_t finished_count) const;

  const RenderOptions& options_;
  const FolderOptions& folder_;
  FilmOfRays rays_;
  FilmSource& source_;
  PassPlan plan_;
  ThreadPool& pool_;
  const std::function<void(const RenderProgress&)>& progress_;
  std::unique_ptr<FilmSetup> setup_;
  std::unique_ptr<RunState> state_;
  RenderProgress done_;
  RenderReport totals_;
  const double begin_s_ = NowSeconds();
  size_t black_count_ = 0;
  bool had_plates_ = false;  // true if an earlier run left plates or rebinned rays
  bool all_broken_ = true;   // true if FilmRenderer::AllBroken() was true of every pass
};

Result<RenderReport> Renderer::Run(Package package) {
  LF_RETURN_IF_ERROR(Begin(std::move(package)));
  std::vector<FrameId> frames = FramesToRender();
  if (!frames.empty()) {
    if (const Result<void> result = RunPasses(std::move(frames)); !result)
      return result.error().kind == ErrorKind::kInterrupted ? Interrupted() : result.error();
  }
  return End();
}

Result<void> Renderer::Begin(Package package) {
  LF_RETURN_IF_ERROR(CheckRenderOptions(package, options_));
  LF_ASSIGN_OR_RETURN(
      setup_, FilmSetup::Make(std::move(package), options_.film,
                              WithFlags(options_.work, options_.signals), options_.frames, pool_));
  LF_RETURN_IF_ERROR(CreateFolder(folder_.output_folder));
  if (folder_.video) {
    LF_RETURN_IF_ERROR(CheckVideoTool());
    LF_RETURN_IF_ERROR(CheckVideoTarget(*folder_.video));
  }
  LF_RETURN_IF_ERROR(OpenState());
  const LightField& light_field = setup_->light_field();
  const Intrinsics& plate = setup_->path().Camera(setup_->frames().front()).pinhole.intrinsics;
  totals_.version = folder_.version;
  totals_.estimator = setup_->film().reading.estimator;
  totals_.width = plate.width_px;
  totals_.height = plate.height_px;
  totals_.thread_count = pool_.thread_count();
  totals_.virtual_count = setup_->package().whole_virtual_count;
  totals_.lf_image_count = setup_->package().whole.image_count - totals_.virtual_count;
  totals_.has_masks =
      !light_field.mask_names.empty() || light_field.encoding.alpha == AlphaMeaning::kMask;
  done_.frame_total = setup_->frames().size();
  if (options_.source == nullptr)
    if (const std::string note = setup_->ReferenceNote(); !note.empty()) LogInfo("{}", note);
  TellPlan();
  return {};
}

// Opens the state in the folder. Sets totals_ to the totals of earlier runs and the inputs of this
// run.
Result<void> Renderer::OpenState() {
  LF_ASSIGN_OR_RETURN(RunInputs rays, InputsOfRays(*setup_));
  for (auto& input : source_.Inputs()) rays.push_back(std::move(input));
  const RunStateOptions state_options = StateOptions(*setup_, folder_, std::move(rays));
  LF_ASSIGN_OR_RETURN(state_, RunState::Open(state_options, setup_->path()));
  if (!setup_->film().shard)
    WarnOfOtherFormat(folder_.output_folder, setup_->frames(), folder_.format);
  had_plates_ = state_->HasPlates();
  totals_ = state_->earlier();
  // If nothing of the earlier run is kept, the LF images that it skipped are tried again.
  if (!had_plates_ && state_->finished().empty()) totals_.skipped.clear();
  if (setup_->work().strict && !totals_.skipped.empty())
    return InputError(fmt::format(
        "{{strict}}: the unfinished render has left out {} LF images, the first: {}; leave "
        "out {{strict}}, or start again with {{overwrite}} instead of {{resume}}",
        totals_.skipped.size(), totals_.skipped.front().reason));
  totals_.inputs = state_options.rays;
  totals_.inputs.insert(totals_.inputs.end(), state_options.picture.begin(),
                        state_options.picture.end());
  return {};
}

// Logs the plan of the render, for debugging.
void Renderer::TellPlan() const {
  const FilmSettings& film = setup_->film();
  const MemoryPlan& plan = setup_->plan();
  LogDebug(
      "rays: mode {}, estimator {}, filter {}, lens weights {}, back end {}; instruction set {}, "
      "{} threads",
      NameOf(film.mode), NameOf(film.reading.estimator), NameOf(film.reading.filter),
      NameOf(film.lens_weights), film.back_end == CollectBackEnd::kFast ? "fast" : "reference",
      SimdTargets().front(), pool_.thread_count());
  LogDebug(
      "memory: {} of {} MiB; up to {} of {} frames a pass with plates of {} KiB, two batches of up "
      "to {} LF images of {} KiB, {} MiB of planned rays, {} rebinned rays",
      plan.total_bytes >> 20, setup_->work().memory_bytes >> 20, plan.frames_per_pass,
      setup_->frames().size(), plan.plate_bytes >> 10, plan.batch_image_count,
      plan.image_bytes >> 10, plan.plan_bytes >> 20, setup_->max_cells());
  if (const ReferenceNeed references = setup_->References(); references.all_bytes > 0)
    LogDebug("memory: {} of {} for reference images", ByteText(plan.reference_bytes),
             ByteText(references.all_bytes));
  LogDebug("state: {} frames are finished, {}; {} LF images were left out before",
           state_->finished().size(), had_plates_ ? "others are begun" : "none is begun",
           totals_.skipped.size());
}

// Returns the frames that are not finished, or that lack a measurement or a plate that the options
// now require.
std::vector<FrameId> Renderer::FramesToRender() {
  std::vector<FrameId> frames;
  for (const FrameId frame : setup_->frames()) {
    const auto finished = state_->finished().find(frame);
    if (finished != state_->finished().end()) {
      const bool lacks_samples = setup_->film().require.samples && !finished->second.samples;
      const bool lacks_noise = setup_->film().require.noise && !finished->second.noise;
      const bool lacks_plate = folder_.keep_plates && !state_->HasPlateBeside(frame);
      if (!lacks_samples && !lacks_noise && !lacks_plate) continue;
      LogInfo("frame {} is rendered again, for {}", frame.value,
              lacks_samples ? "{require}: its samples were not measured"
              : lacks_noise ? "{require}: its noise was not measured"
                            : "{keep_plates}");
      state_->Forget(frame);
    }
    frames.push_back(frame);
  }
  done_.frame_count = setup_->frames().size() - frames.size();
  return frames;
}

Result<void> Renderer::RunPasses(std::vector<FrameId> frames) {
  LF_ASSIGN_OR_RETURN(plan_, source_.Plan(setup_.get(), frames));
  const bool rebins = setup_->film().Rebins();
  const size_t per_pass = plan_.frames_per_pass;
  totals_.pass_count = (frames.size() + per_pass - 1) / per_pass * plan_.readings;
  if (totals_.pass_count > 1)
    LogInfo("{} frames in {} passes over the LF images: {} fit in the memory", frames.size(),
            totals_.pass_count, plan_.fitting);
  DumpClock clock(folder_.dump_every_s, NowSeconds());
  const PassContext context = {
      *setup_,
      folder_,
      source_.Metadata(),
      plan_.frames_finished_at_once,
      options_.signals,
      *state_,
      clock,
      totals_,
      begin_s_,
      black_count_,
      [this](const CollectProgress& pass, size_t finished_count) { Report(pass, finished_count); }};
  // Finds out now, and not after hours of work, that no LF image contributes to the film. The check
  // is skipped if an earlier run left plates or frames, because LF images then contribute.
  if (totals_.pass_count > 1 && IsWhole() && !rebins && !state_->HasPlates() &&
      state_->finished().empty())
    LF_RETURN_IF_ERROR(CheckAnyContributes(frames));
  if (!rebins) LF_RETURN_IF_ERROR(FinishEarly(context, &frames));
  // Which rebinned rays are kept depends on all frames of a pass. A resumed render must therefore
  // divide all frames, even finished ones, into the same passes.
  const std::span<const FrameId> in_passes = rebins ? std::span(setup_->frames()) : frames;
  for (size_t begin = 0; begin < in_passes.size(); begin += per_pass) {
    const size_t count = std::min(per_pass, in_passes.size() - begin);
    const std::span<const FrameId> of_pass = in_passes.subspan(begin, count);
    if (std::all_of(of_pass.begin(), of_pass.end(),
                    [this](FrameId frame) { return state_->finished().contains(frame); }))
      continue;
    const std::vector<FrameId> early = rebins ? EarlyOf(of_pass) : std::vector<FrameId>();
    LF_RETURN_IF_ERROR(RunPass(context, of_pass, in_passes.size() - begin, early));
  }
  return {};
}

Result<void> Renderer::CheckAnyContributes(std::span<const FrameId> frames) const {
  // With lens weights, LF cameras beside the lens contribute as well; only RenderPass can find
  // these.
  if (setup_->film().lens_weights != LensWeights::kNone) return {};
  std::vector<RenderCamera> cameras;
  for (const FrameId frame : frames) {
    const std::span<const RenderCamera> instants = setup_->path().Instants(frame);
    cameras.insert(cameras.end(), instants.begin(), instants.end());
  }
  const bool any_contributes =
      !SelectImages(setup_->index(), cameras, setup_->Select(), pool_).empty();
  if (IsStopped()) return Interrupted();
  if (!any_contributes) return NoneContributes(setup_->frames());
  return {};
}

// Returns those of `frames` that are to be finished early, with the rays that the state has of
// them. Warns about the frames of finish_early of which the state has no plate.
std::vector<FrameId> Renderer::EarlyOf(std::span<const FrameId> frames) const {
  std::vector<FrameId> early;
  for (const FrameId frame : folder_.finish_early) {
    if (std::find(frames.begin(), frames.end(), frame) == frames.end()) continue;
    if (state_->finished().contains(frame)) continue;
    // With kRebin, only RenderPass finds out which rays the state has.
    if (!setup_->film().Collects() || state_->HasPlate(frame))
      early.push_back(frame);
    else
      LogWarning(
          "{{finish}}: frame {} has no rays yet, and is therefore rendered from all of its LF "
          "images",
          frame.value);
  }
  return early;
}

// Finishes the early frames in separate passes, so that they need not wait for other frames, and
// removes them from `frames`.
Result<void> Renderer::FinishEarly(const PassContext& context, std::vector<FrameId>* frames) {
  const std::vector<FrameId> early = EarlyOf(*frames);
  std::erase_if(*frames, [&early](FrameId frame) {
    return std::binary_search(early.begin(), early.end(), frame);
  });
  const size_t per_pass = plan_.frames_per_pass;
  for (size_t begin = 0; begin < early.size(); begin += per_pass) {
    const size_t count = std::min(per_pass, early.size() - begin);
    const std::span<const FrameId> of_pass = std::span(early).subspan(begin, count);
    LF_RETURN_IF_ERROR(RunPass(context, of_pass, frames->size() + count, of_pass));
  }
  return {};
}

Result<void> Renderer::RunPass(const PassContext& context, std::span<const FrameId> frames,
                               size_t frames_left, std::span<const FrameId> early) {
  const auto finished_before = std::count_if(frames.begin(), frames.end(), [this](FrameId frame) {
    return state_->finished().contains(frame);
  });
  RenderPass pass(context, source_.Open(*setup_, frames), early);
  LF_RETURN_IF_ERROR(pass.Prepare());
  const std::vector<SelectedImage>& images = pass.source().images();
  if (images.empty() && IsWhole() && totals_.pass_count == 1 && !state_->HasPlates() &&
      state_->finished().empty())
    return NoneContributes(setup_->frames());
  // The estimate of the total work assumes that later passes are as long as this one.
  const size_t passes_left = (frames_left + frames.size() - 1) / frames.size();
  const CollectProgress total = pass.source().total();
  LogDebug("pass over {} LF images for {} frames, {} to {}: {} pixels to be tried", images.size(),
           frames.size(), frames.front().value, frames.back().value, total.tested_count);
  done_.image_total = done_.image_count + total.image_count * passes_left;
  done_.ray_total = done_.ray_count + total.tested_count * passes_left;
  LF_RETURN_IF_ERROR(pass.Collect());

  // CheckNotAllBroken() of one pass would make the result depend on the number of passes, and
  // thereby on the memory. Its error is therefore returned only after the last pass, and only if
  // every LF image of every pass is broken.
  all_broken_ = all_broken_ && pass.source().AllBroken();
  const bool is_last = frames_left == frames.size();
  if (all_broken_ && is_last && !setup_->film().shard && !pass.source().skipped().empty() &&
      !had_plates_ && state_->finished().empty()) {
    state_->RemoveAll();  // checkpoints may have written plates without a ray
    return pass.source().CheckNotAllBroken();
  }
  LF_RETURN_IF_ERROR(pass.Finish());
  done_.image_count += total.image_count;
  done_.ray_count += total.tested_count;
  done_.frame_count += frames.size() - static_cast<size_t>(finished_before);
  Report({}, 0);
  return {};
}

Result<RenderReport> Renderer::End() {
  const FilmFiles film = FilesOfFilm(setup_->path(), options_);
  std::optional<Error> video_error;
  if (folder_.contact_sheet && !setup_->film().shard)
    if (const Result<void> sheet =
            film.WriteContactSheet(setup_->frames(), setup_->plan().frames_finished_at_once, pool_);
        !sheet)
      return sheet.error().kind == ErrorKind::kInterrupted ? Interrupted() : sheet.error();
  // An error of the video is returned last, because the frames, which matter more, are finished.
  if (folder_.video)
    if (const Result<void> video = film.WriteVideo(setup_->frames(), *folder_.video); !video)
      video_error = video.error();
  if (video_error && video_error->kind == ErrorKind::kInterrupted) return Interrupted();
  if (folder_.complete) {
    if (const Result<void> completed = folder_.complete(); !completed)
      return completed.error().kind == ErrorKind::kInterrupted ? Interrupted() : completed.error();
  }
  for (const auto& [frame, report] : state_->finished()) totals_.frames.push_back(report);
  totals_.total_s += NowSeconds() - begin_s_;
  totals_.peak_memory_bytes = std::max(totals_.peak_memory_bytes, PeakMemoryBytes());
  LF_RETURN_IF_ERROR(state_->Close(totals_));
  if (totals_.IsBlack() && IsWhole())
    return InputError(fmt::format(
        "{}: all frames are black, because no pixel of the {} LF images has a ray for them: "
        "check {}",
        folder_.output_folder.string(), totals_.selected_image_count,
        setup_->film().mode == RenderMode::kRebin && KeepsCells(setup_->film())
            ? "the masks of the LF images, {slab_position}, {slab_distance}, {r_st} and "
              "{r_uv}"
        : totals_.rebinning && totals_.rebinning->kept == "edges"
            ? "whether masks exclude all pixels, or {alpha} and {xi} keep none"
            : "whether masks exclude all pixels"));
  if (video_error) return *video_error;
  return std::move(totals_);
}

void Renderer::Report(const CollectProgress& pass, size_t finished_count) const {
  if (!progress_) return;
  RenderProgress now = done_;
  now.image_count += pass.image_count;
  now.ray_count += pass.tested_count;
  now.frame_count += finished_count;
  progress_(now);
}

}  // namespace

Result<RenderReport> Render(Package package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress) {
  return Renderer(options, pool, progress).Run(std::move(package));
}

}  // namespace lf
