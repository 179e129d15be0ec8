#include "lf/pipeline/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "lf/collection/simd_target.h"
#include "lf/collector/noise_moments.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/hybrid/film_slabs.h"
#include "lf/hybrid/render_memory.h"
#include "lf/packed/packed_store_file.h"
#include "lf/pipeline/check_render_options.h"
#include "lf/pipeline/frame_output.h"
#include "lf/pipeline/render_pass.h"
#include "lf/preprocess/film_order.h"
#include "lf/preprocess/frame_needs.h"
#include "lf/record/run_state.h"
#include "lf/sequence/video.h"
#include "lf/store/open_store.h"

namespace lf {

namespace {

// Returns the inputs that only rebinned rays depend on; none if the mode is kCollect.
//   film  hash of all render cameras of the film, on which slabs depend
RunInputs InputsOfRebinning(const RenderOptions& options, size_t max_cells,
                            const std::string& film) {
  if (options.mode == RenderMode::kCollect) return {};
  const RebinPassOptions& rebin = options.rebin;
  const ProbabilityOptions& edges = rebin.rebin.probability;
  const auto width = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string("auto");
  };
  const auto place = [](const std::optional<Vec3>& v) {
    return v ? fmt::format("{} {} {}", v->x(), v->y(), v->z()) : std::string("auto");
  };
  return {
      {"mode", NameOf(options.mode)},
      {"rebin.film", film},
      {"rebin.max_rays", fmt::format("{}", max_cells)},
      {"rebin.kept", NameOf(rebin.kept)},
      {"rebin.edges", fmt::format("alpha {} beta {} xi {} sigma {} then {}", edges.alpha,
                                  edges.beta, edges.xi, edges.sigma_px, edges.second_sigma_px)},
      {"rebin.colours", fmt::format("sigma {}", rebin.rebin.colour_sigma_px)},
      {"rebin.others", rebin.rebin.averages_others ? "averaged" : "left out"},
      {"rebin.seed", fmt::format("{}", rebin.rebin.seed)},
      {"rebin.preview", NameOf(rebin.previews)},
      {"rebin.query", fmt::format("sigma_st {} sigma_uv {} lens points {} sets {} on {} nearest {}",
                                  rebin.query.sigma_st, rebin.query.sigma_uv,
                                  rebin.query.lens_point_count, rebin.query.lens_sets,
                                  rebin.reparameterise ? "focus planes" : "slabs", rebin.nearest)},
      {"rebin.slab", fmt::format("position {} forward {} distance {} r_st {} r_uv {}",
                                 place(rebin.slab.position_world), place(rebin.slab.forward_world),
                                 width(rebin.slab.uv_distance_w), width(rebin.slab.r_st_w),
                                 width(rebin.slab.r_uv_w))},
      {"rebin.coverage", fmt::format("{} cells across", rebin.coverage.cells_across)}};
}

// Returns the codec settings by which the pixels of LF images differ from the recorded ones, or the
// value for pixels as recorded.
Result<std::string> PixelsOf(const LightField& light_field) {
  const std::string as_recorded = RunChoices().pixels;
  if (!HoldsPackedStore(light_field)) return as_recorded;
  LF_ASSIGN_OR_RETURN(std::string codec, ReadCodecSettings(light_field.folder));
  return codec.starts_with(kLosslessCodec) ? as_recorded : codec;
}

RunStateOptions StateOptions(const Package& package, const RenderOptions& options,
                             const std::string& pixels, size_t max_cells) {
  RunChoices choices;
  choices.pixels = pixels;
  choices.reading = options.reading;
  choices.lens_weights = options.lens_weights;
  choices.back_end = options.back_end;
  choices.order = package.choices.order;
  choices.seed = package.choices.seed;
  choices.max_image_count = options.max_image_count;
  choices.max_angle_rad = package.choices.max_angle_rad;
  choices.stop_at_samples = options.stop_at_samples;
  choices.stop_at_noise = options.stop_at_noise;
  choices.format = NameOf(options.format);
  choices.smooth_below = options.smooth_below;
  choices.fill_radius_px = options.fill_radius_px;
  RunInputs picture = InputsOfPicture(choices);
  if (!package.name.empty()) picture.emplace_back(kFilmOfPackage, HashOfCameras(package.path));
  RunInputs rays = InputsOfRays(package.whole, package.light_field.encoding, choices);
  for (auto& input : InputsOfRebinning(options, max_cells, HashOfCameras(package.path)))
    rays.push_back(std::move(input));
  return {options.output_folder, package.name,       package.FrameIds(),
          options.format,        options.resume,     options.overwrite,
          std::move(rays),       std::move(picture), options.shard};
}

// One render: its inputs, and the results of its passes.
class Renderer {
 public:
  Renderer(const Package& package, const RenderOptions& options, ThreadPool& pool,
           const std::function<void(const RenderProgress&)>& progress)
      : package_(package),
        path_(package.path),
        options_(options),
        pool_(pool),
        progress_(progress),
        index_(package.light_field, package.places) {}

  Result<RenderReport> Run();

 private:
  // True for a whole film, which must not be black. A section of a film, or a shard, may be.
  bool IsWhole() const { return package_.name.empty() && !options_.shard; }
  Result<void> Begin();
  Result<void> PlanSlabs();
  Result<void> CheckStore() const;
  void TellPlan() const;
  std::vector<FrameId> FramesToRender();
  Result<void> RunPasses(std::vector<FrameId> frames);
  std::vector<FrameId> EarlyOf(const RenderJob& job, std::span<const FrameId> frames) const;
  Result<void> FinishEarly(const RenderJob& job, std::vector<FrameId>* frames);
  Result<void> RunPass(const RenderJob& job, std::span<const FrameId> frames, size_t frames_left,
                       std::span<const FrameId> early);
  Result<RenderReport> End();
  Result<void> CheckAnyContributes(const RenderJob& job, std::span<const FrameId> frames) const;
  Error NoneContributes() const;
  Error Interrupted() const;
  void Report(const CollectProgress& pass, size_t finished_count) const;

  const Package& package_;
  const CameraPath& path_;
  const RenderOptions& options_;
  ThreadPool& pool_;
  const std::function<void(const RenderProgress&)>& progress_;
  ImageIndex index_;
  std::unique_ptr<LfImageStore> store_;

  std::vector<FrameId> frames_;
  MemoryPlan plan_;
  size_t max_cells_ = 0;  // of rebinned rays
  std::optional<FilmSlabs> slabs_;
  std::unique_ptr<RunState> state_;
  RenderProgress done_;
  RenderReport totals_;
  const double begin_s_ = NowSeconds();
  size_t black_count_ = 0;
  bool had_plates_ = false;  // of an earlier run
  bool all_broken_ = true;   // every LF image of every pass so far was broken
};

Result<RenderReport> Renderer::Run() {
  LF_RETURN_IF_ERROR(Begin());
  std::vector<FrameId> frames = FramesToRender();
  if (!frames.empty()) {
    if (const Result<void> result = RunPasses(std::move(frames)); !result)
      return result.error().kind == ErrorKind::kInterrupted ? Interrupted() : result.error();
  }
  return End();
}

Result<void> Renderer::Begin() {
  frames_ = options_.frames;
  if (frames_.empty()) frames_ = package_.FrameIds();
  LF_RETURN_IF_ERROR(CheckRenderOptions(package_, options_));
  LF_ASSIGN_OR_RETURN(
      store_, OpenStore(package_.light_field, options_.reading.estimator == Estimator::kBilinear
                                                  ? Mosaics::kToRgb
                                                  : Mosaics::kAsRecorded));
  LF_RETURN_IF_ERROR(CheckStore());
  const Intrinsics& plate = path_.Camera(frames_.front()).pinhole.intrinsics;
  LF_ASSIGN_OR_RETURN(
      const RenderMemory memory,
      PlanRenderMemory(options_.memory_bytes, options_.mode, options_.rebin.max_cells,
                       package_.light_field, options_.reading.estimator, plate.width_px,
                       plate.height_px, frames_.size(), pool_.thread_count(),
                       options_.MeasuresNoise() ? NoiseMoments::kMostBytes : 0));
  plan_ = memory.plan;
  max_cells_ = memory.max_cells;
  LF_RETURN_IF_ERROR(CreateFolder(options_.output_folder));
  if (options_.video) {
    LF_RETURN_IF_ERROR(CheckVideoTool());
    LF_RETURN_IF_ERROR(CheckVideoTarget(*options_.video));
  }
  LF_ASSIGN_OR_RETURN(const std::string pixels, PixelsOf(package_.light_field));
  const RunStateOptions state_options = StateOptions(package_, options_, pixels, max_cells_);
  LF_ASSIGN_OR_RETURN(state_, RunState::Open(state_options, path_));
  had_plates_ = state_->HasPlates();
  totals_ = state_->earlier();
  // LF images that the earlier run skipped are tried again if nothing of that run is kept.
  if (!had_plates_ && state_->finished().empty()) totals_.skipped.clear();
  if (options_.strict && !totals_.skipped.empty())
    return InputError(fmt::format(
        "--strict: the render that --resume goes on with skipped {} LF images, the first: {}",
        totals_.skipped.size(), totals_.skipped.front().reason));
  totals_.version = options_.version;
  totals_.inputs = state_options.rays;
  totals_.inputs.insert(totals_.inputs.end(), state_options.picture.begin(),
                        state_options.picture.end());
  totals_.estimator = options_.reading.estimator;
  totals_.width = plate.width_px;
  totals_.height = plate.height_px;
  totals_.thread_count = pool_.thread_count();
  totals_.lf_image_count = package_.whole.image_count;
  const LightField& light_field = package_.light_field;
  totals_.has_masks =
      !light_field.mask_names.empty() || light_field.encoding.alpha == AlphaMeaning::kMask;
  done_.frame_total = frames_.size();
  TellPlan();
  return {};
}

// Logs the plan of the render, for debugging.
void Renderer::TellPlan() const {
  LogDebug(
      "rays: mode {}, estimator {}, filter {}, lens weights {}, back end {}; instruction set {}, "
      "{} threads",
      NameOf(options_.mode), NameOf(options_.reading.estimator), NameOf(options_.reading.filter),
      NameOf(options_.lens_weights),
      options_.back_end == CollectBackEnd::kFast ? "fast" : "reference", SimdTargets().front(),
      pool_.thread_count());
  LogDebug(
      "memory: {} of {} MiB; up to {} of {} frames a pass with plates of {} KiB, two batches of up "
      "to {} LF images of {} KiB, {} MiB of planned rays, {} rebinned rays",
      plan_.total_bytes >> 20, options_.memory_bytes >> 20, plan_.frames_per_pass, frames_.size(),
      plan_.plate_bytes >> 10, plan_.batch_image_count, plan_.image_bytes >> 10,
      plan_.plan_bytes >> 20, max_cells_);
  LogDebug("state: {} frames are finished, {}; {} LF images were left out before",
           state_->finished().size(), had_plates_ ? "others are begun" : "none is begun",
           totals_.skipped.size());
}

// Checks, frame by frame, that the store keeps all pixels that the frames need: this is better
// known before a night's work than after it.
Result<void> Renderer::CheckStore() const {
  if (!store_->IsPartial()) return {};
  const NeedsOptions needs = NeedsOfRender(package_, options_);
  for (const FrameId frame : frames_) {
    const std::optional<FrameSampling> sampling =
        package_.surroundings.empty()
            ? std::nullopt
            : std::optional(SamplingOf(package_.surroundings[frame.value - 1]));
    const FrameNeeds wanted = NeedsOf(index_, path_.Camera(frame), needs, pool_, sampling);
    if (needs.select.interrupted != nullptr && *needs.select.interrupted) return {};
    LF_RETURN_IF_ERROR(CheckKept(*store_, package_.light_field, frame, wanted));
  }
  return {};
}

// Plans the slabs of the whole film, so that a frame has the same slab in any package and any pass.
Result<void> Renderer::PlanSlabs() {
  if (!Rebins(options_.mode)) return {};
  std::vector<FrameSampling> sampling;
  for (const FrameSurroundings& around : package_.surroundings)
    sampling.push_back(SamplingOf(around));
  if (sampling.empty()) {
    LF_ASSIGN_OR_RETURN(
        sampling, SamplingOfFilm(index_, path_, NeedsOfRender(package_, options_).select, pool_));
  }
  slabs_.emplace(path_.cameras, sampling, options_.rebin.query, options_.rebin.slab);
  return {};
}

// Returns the frames that are not finished, or lack a measurement or a plate that is asked for now.
std::vector<FrameId> Renderer::FramesToRender() {
  std::vector<FrameId> frames;
  for (const FrameId frame : frames_) {
    const auto finished = state_->finished().find(frame);
    if (finished != state_->finished().end()) {
      std::filesystem::path plate = FramePath(options_.output_folder, frame, options_.format);
      const bool lacks_samples = options_.require_samples && !finished->second.samples;
      const bool lacks_noise = options_.require_noise && !finished->second.noise;
      const bool lacks_plate =
          options_.keep_plates && !std::filesystem::exists(plate.replace_extension(".plate"));
      if (!lacks_samples && !lacks_noise && !lacks_plate) continue;
      LogInfo("frame {} is rendered again, for {}", frame.value,
              lacks_samples ? "--require: its samples were not measured"
              : lacks_noise ? "--require: its noise was not measured"
                            : "--keep-plates");
      state_->Forget(frame);
    }
    frames.push_back(frame);
  }
  done_.frame_count = frames_.size() - frames.size();
  return frames;
}

Result<void> Renderer::RunPasses(std::vector<FrameId> frames) {
  LF_RETURN_IF_ERROR(PlanSlabs());
  const size_t per_pass = plan_.frames_per_pass;
  totals_.pass_count = (frames.size() + per_pass - 1) / per_pass;
  if (totals_.pass_count > 1)
    LogInfo("{} frames in {} passes over the LF images: {} plates of {} MiB fit in the memory",
            frames.size(), totals_.pass_count, per_pass, plan_.plate_bytes >> 20);
  DumpClock clock(options_.dump_every_s, NowSeconds());
  const RenderJob job = {
      package_,
      index_,
      path_,
      options_,
      pool_,
      *store_,
      plan_,
      *state_,
      clock,
      totals_,
      max_cells_,
      slabs_ ? &*slabs_ : nullptr,
      begin_s_,
      black_count_,
      [this](const CollectProgress& pass, size_t finished_count) { Report(pass, finished_count); }};
  // A film without contributing LF images is better reported before a night's work than after it.
  // If an earlier run left plates or frames, LF images contribute.
  if (totals_.pass_count > 1 && IsWhole() && !job.Rebins() && !state_->HasPlates() &&
      state_->finished().empty())
    LF_RETURN_IF_ERROR(CheckAnyContributes(job, frames));
  if (!job.Rebins()) LF_RETURN_IF_ERROR(FinishEarly(job, &frames));
  // The kept rebinned rays depend on all frames of a pass, so a resumed render must have passes of
  // the same frames.
  const std::span<const FrameId> in_passes = job.Rebins() ? std::span(frames_) : frames;
  for (size_t begin = 0; begin < in_passes.size(); begin += per_pass) {
    const size_t count = std::min(per_pass, in_passes.size() - begin);
    const std::span<const FrameId> of_pass = in_passes.subspan(begin, count);
    if (std::all_of(of_pass.begin(), of_pass.end(),
                    [this](FrameId frame) { return state_->finished().contains(frame); }))
      continue;
    const std::vector<FrameId> early =
        job.Rebins() ? EarlyOf(job, of_pass) : std::vector<FrameId>();
    LF_RETURN_IF_ERROR(RunPass(job, of_pass, in_passes.size() - begin, early));
  }
  return {};
}

Error Renderer::NoneContributes() const {
  return InputError(fmt::format(
      "no LF image contributes to frames {}-{}: no recorded ray passes both their lens and what "
      "they see (is the aperture smaller than the camera spacing, or the camera off the capture?)",
      frames_.front().value, frames_.back().value));
}

Result<void> Renderer::CheckAnyContributes(const RenderJob& job,
                                           std::span<const FrameId> frames) const {
  // With lens weights, LF cameras beside the lens contribute, which only a pass can tell.
  if (options_.lens_weights != LensWeights::kNone) return {};
  std::vector<RenderCamera> cameras;
  for (const FrameId frame : frames) cameras.push_back(path_.Camera(frame));
  const bool any_contributes = !SelectImages(index_, cameras, job.Select(), pool_).empty();
  if (job.IsStopped()) return Interrupted();
  if (!any_contributes) return NoneContributes();
  return {};
}

// Returns the frames of the pass that are to be finished with the rays that the state has of them.
std::vector<FrameId> Renderer::EarlyOf(const RenderJob& job,
                                       std::span<const FrameId> frames) const {
  std::vector<FrameId> early;
  for (const FrameId frame : options_.finish_early) {
    if (std::find(frames.begin(), frames.end(), frame) == frames.end()) continue;
    if (state_->finished().contains(frame)) continue;
    // Without collection, only the pass knows which rays the state has.
    if (!job.Collects() || state_->HasPlate(frame))
      early.push_back(frame);
    else
      LogWarning("--finish: frame {} has no rays yet: it takes all of its LF images", frame.value);
  }
  return early;
}

// Finishes the early frames in passes of their own, so that they need not wait for others, and
// removes them from `frames`.
Result<void> Renderer::FinishEarly(const RenderJob& job, std::vector<FrameId>* frames) {
  const std::vector<FrameId> early = EarlyOf(job, *frames);
  std::erase_if(*frames, [&early](FrameId frame) {
    return std::binary_search(early.begin(), early.end(), frame);
  });
  for (size_t begin = 0; begin < early.size(); begin += plan_.frames_per_pass) {
    const size_t count = std::min(plan_.frames_per_pass, early.size() - begin);
    const std::span<const FrameId> of_pass = std::span(early).subspan(begin, count);
    LF_RETURN_IF_ERROR(RunPass(job, of_pass, frames->size() + count, of_pass));
  }
  return {};
}

Result<void> Renderer::RunPass(const RenderJob& job, std::span<const FrameId> frames,
                               size_t frames_left, std::span<const FrameId> early) {
  const auto finished_before = std::count_if(frames.begin(), frames.end(), [this](FrameId frame) {
    return state_->finished().contains(frame);
  });
  RenderPass pass(job, frames, early);
  LF_RETURN_IF_ERROR(pass.Prepare());
  const std::vector<SelectedImage>& images = pass.images();
  if (images.empty() && IsWhole() && totals_.pass_count == 1 && !state_->HasPlates() &&
      state_->finished().empty())
    return NoneContributes();
  // The progress estimate assumes that later passes are like this one.
  const size_t passes_left = (frames_left + frames.size() - 1) / frames.size();
  const uint64_t rays = std::accumulate(
      images.begin(), images.end(), uint64_t{0},
      [](uint64_t sum, const SelectedImage& image) { return sum + image.ray_count; });
  LogDebug("pass over {} LF images for {} frames, {} to {}: {} pixels to be tried", images.size(),
           frames.size(), frames.front().value, frames.back().value, rays);
  done_.image_total = done_.image_count + images.size() * passes_left;
  done_.ray_total = done_.ray_count + rays * passes_left;
  LF_RETURN_IF_ERROR(pass.Collect());

  // Passes depend on the memory, but this error must not: it needs all LF images of all passes.
  all_broken_ = all_broken_ && pass.AllBroken();
  const bool is_last = frames_left == frames.size();
  if (all_broken_ && is_last && !options_.shard && !pass.skipped().empty() && !had_plates_ &&
      state_->finished().empty()) {
    state_->RemoveAll();  // checkpoints may have written plates without a ray
    return InputError(
        fmt::format("every LF image is broken; the first: {}", pass.skipped().front().reason));
  }
  LF_RETURN_IF_ERROR(pass.Finish());
  done_.image_count += images.size();
  done_.ray_count += rays;
  done_.frame_count += frames.size() - static_cast<size_t>(finished_before);
  Report({}, 0);
  return {};
}

Result<RenderReport> Renderer::End() {
  const FilmFiles film = FilesOfFilm(path_, options_);
  std::optional<Error> video_error;
  if (options_.contact_sheet && !options_.shard)
    if (const Result<void> sheet =
            film.WriteContactSheet(frames_, plan_.frames_finished_at_once, pool_);
        !sheet)
      return sheet.error().kind == ErrorKind::kInterrupted ? Interrupted() : sheet.error();
  // An error of the video comes last, because the frames are finished and matter most.
  if (options_.video)
    if (const Result<void> video = film.WriteVideo(frames_, *options_.video); !video)
      video_error = video.error();
  if (video_error && video_error->kind == ErrorKind::kInterrupted) return Interrupted();
  for (const auto& [frame, report] : state_->finished()) totals_.frames.push_back(report);
  totals_.total_s += NowSeconds() - begin_s_;
  totals_.peak_memory_bytes = PeakMemoryBytes();
  LF_RETURN_IF_ERROR(state_->Close(totals_));
  if (totals_.IsBlack() && IsWhole())
    return InputError(fmt::format(
        "{}: every frame is black: no ray of {} LF images reached them ({})",
        options_.output_folder.string(), totals_.selected_image_count,
        options_.mode == RenderMode::kRebin
            ? "are the images masked, or do --slab-position, --slab-distance, --r-st or --r-uv not "
              "fit the scene?"
            : "are the images masked?"));
  if (video_error) return *video_error;
  return std::move(totals_);
}

Error Renderer::Interrupted() const {
  size_t finished_count = 0;
  for (const FrameId frame : frames_) finished_count += state_->finished().contains(frame) ? 1 : 0;
  return {ErrorKind::kInterrupted,
          fmt::format("interrupted after {} of {} frames; what is done is "
                      "kept in {}",
                      finished_count, frames_.size(), options_.output_folder.string())};
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

Result<RenderReport> Render(const Package& package, const RenderOptions& options, ThreadPool& pool,
                            const std::function<void(const RenderProgress&)>& progress) {
  return Renderer(package, options, pool, progress).Run();
}

}  // namespace lf
