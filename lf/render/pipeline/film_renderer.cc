// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/film_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lf/core/byte_text.h"
#include "lf/core/log.h"
#include "lf/film/develop/completion.h"
#include "lf/render/collect/around_lens.h"
#include "lf/render/collect/mosaic_share.h"
#include "lf/render/hybrid/frame_sampling.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/settings/interpolation.h"

namespace lf {

Result<std::unique_ptr<FilmRenderer>> FilmRenderer::Open(Package package, const FilmSettings& film,
                                                         const WorkSettings& work,
                                                         std::vector<FrameId> frames,
                                                         ThreadPool& pool) {
  LF_ASSIGN_OR_RETURN(std::unique_ptr<FilmSetup> setup,
                      FilmSetup::Make(std::move(package), film, work, std::move(frames), pool));
  const size_t fit = setup->plan().frames_per_pass;
  if (fit < setup->frames().size())
    return OutputError(fmt::format(
        "{} frames cannot be rendered at the same time, because {} of memory are enough "
        "for only {} frames: allow more memory, or render fewer frames",
        setup->frames().size(), ByteText(work.memory_bytes), fit));
  LF_RETURN_IF_ERROR(setup->PlanSlabs());
  auto renderer = std::make_unique<FilmRenderer>(*setup, setup->frames());
  renderer->own_setup_ = std::move(setup);
  LF_RETURN_IF_ERROR(renderer->Begin());
  return renderer;
}

FilmRenderer::FilmRenderer(const FilmSetup& setup, std::span<const FrameId> frames)
    : setup_(setup), film_(setup.film()), select_(setup.Select()), frames_(frames.size()) {
  for (size_t f = 0; f < frames.size(); ++f) frames_[f].id = frames[f];
}

Result<void> FilmRenderer::Begin(const RunState* state, std::span<const FrameId> early) {
  for (Frame& frame : frames_) {
    frame.is_released = state != nullptr && state->finished().contains(frame.id);
    frame.is_early = std::binary_search(early.begin(), early.end(), frame.id);
  }
  LF_RETURN_IF_ERROR(FindLenses());
  if (film_.max_image_count)
    setup_.pool().ForEach(frames_.size(), [this](size_t f) {
      frames_[f].ranks = RanksOfFirst(*film_.max_image_count, counted_index(),
                                      TakingInstants(frames_[f]), select_);
    });
  ChooseCorrections();
  if (KeepsPixels(film_))
    LF_RETURN_IF_ERROR(PreparePixels(state));
  else if (film_.Rebins())
    LF_RETURN_IF_ERROR(PrepareRebinning(state));
  else if (state != nullptr)
    LF_RETURN_IF_ERROR(state->CheckNoRays());
  if (film_.HasPlates()) LF_RETURN_IF_ERROR(PreparePlates(state));
  if ((rebinned_ || pixels_) && film_.HasStopRule()) ForgetRaysAhead();
  SelectForFrames();
  if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};

  CollectOptions collect = OptionsOfCollector();
  if (film_.HasStopRule()) LF_RETURN_IF_ERROR(PrepareStops(&collect));
  collector_ = std::make_unique<FrameCollector>(
      setup_.light_field(), setup_.store(), FramesOfCollector(), images_, collect, setup_.pool());
  for (size_t i = 0; rebinned_ && i < rebinned_->section_count(); ++i)
    saved_rays_ranks_.push_back(rebinned_->ranks_done(i));
  if (pixels_) saved_rays_ranks_.push_back(pixels_->ranks_done());
  EndEarlyFrames();
  DecideStops();  // an earlier run may have ended exactly where the stop rule is applied
  for (size_t f = 0; film_.HasPlates() && f < frames_.size(); ++f)
    if (!IsReleased(f)) frames_[f].saved_ranks = Progress(f).ranks_done;
  return {};
}

Result<void> FilmRenderer::FindLenses() {
  for (Frame& frame : frames_) {
    if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    const CameraPath& path = setup_.path();
    const Package& package = setup_.package();
    std::span<const double> distances_w = package.InstantDistances(frame.id);
    const std::optional<double> distance_w = setup_.is_guarded()
                                                 ? package.RecordedCameraDistance(frame.id)
                                                 : package.CameraDistance(frame.id);
    if (!path.shutter.exists() && distance_w) distances_w = {&*distance_w, 1};
    frame.lenses = LensesOf(counted_index(), path.Instants(frame.id), film_.lens_weights, select_,
                            setup_.pool(), distances_w);
    if (setup_.is_guarded())
      frame.all_lens.emplace(setup_.index(), path.Camera(frame.id), film_.lens_weights, select_,
                             setup_.pool(), package.CameraDistance(frame.id));
  }
  return {};
}

// Chooses how strongly mosaics are corrected, from all LF images that a frame may take: neither a
// shard nor an earlier run changes the choice.
void FilmRenderer::ChooseCorrections() {
  if ((!film_.HasPlates() && !KeepsPixels(film_)) ||
      film_.reading.estimator != Estimator::kBilinear ||
      film_.reading.filter != PixelFilter::kMosaic)
    return;
  std::vector<std::vector<LfImageId>> images(frames_.size());
  for (size_t f = 0; f < frames_.size() && !setup_.work().IsStopped(); ++f)
    for (const SelectedImage& image :
         SelectImages(counted_index(), TakingInstants(frames_[f]), select_, setup_.pool()))
      images[f].push_back(image.id);
  setup_.pool().ForEach(frames_.size(), [&](size_t f) {
    if (setup_.work().IsStopped()) return;
    const double share = MosaicShareOf(frames_[f].lenses, images[f]);
    frames_[f].correction = CorrectionFor(share);
    LogInfo(
        "frame {}: mosaics are corrected with strength {}, because {:.2g} of a random error is "
        "left in the mean of {} LF images",
        frames_[f].id.value, frames_[f].correction, share, images[f].size());
  });
}

// Returns the description of a frame by which selection finds the LF images whose rays have a
// weight above 0 in a lens of the frame.
TakingFrame FilmRenderer::Taking(const Frame& frame, const FrameLens& lens) const {
  TakingFrame taking = {lens.camera(), frame.ranks};
  if (film_.lens_weights != LensWeights::kNone || setup_.is_guarded())
    taking.takes = [&lens](LfImageId id) { return lens.Takes(id); };
  return taking;
}

std::vector<TakingFrame> FilmRenderer::TakingInstants(const Frame& frame) const {
  std::vector<TakingFrame> taking;
  for (const FrameLens& lens : frame.lenses) taking.push_back(Taking(frame, lens));
  return taking;
}

// Returns the weights of rays in a lens, which must outlive the result; an empty function if all
// rays have weight 1.
ImageWeights FilmRenderer::WeightsIn(const FrameLens& lens) const {
  if (film_.lens_weights == LensWeights::kNone && !setup_.package().choices.max_angle_rad &&
      !setup_.is_guarded() && setup_.light_field().slice_times.size() < 2)
    return {};
  return [&lens](LfImageId id) { return lens.WeightsOf(id); };
}

CollectOptions FilmRenderer::OptionsOfCollector() const {
  const WorkSettings& work = setup_.work();
  CollectOptions collect;
  collect.reading = film_.reading;
  collect.back_end = film_.back_end;
  collect.batch_image_count = static_cast<int>(setup_.plan().batch_image_count);
  collect.plan_bytes = setup_.plan().plan_bytes;
  collect.strict = work.strict;
  collect.whole_images = work.whole_images;
  collect.interrupted = work.interrupted;
  collect.rank_end = setup_.index().rank_end();
  collect.decision_ranks = 0;
  // The rays of all instants of a frame are collected before an interruption.
  collect.batch_frame_ray_count /= static_cast<uint64_t>(setup_.path().shutter.samples);
  if (rebinned_ || pixels_) collect.decision_ranks = kDecisionRanks;
  if (rebinned_) collect.consumer = rebinned_.get();
  if (pixels_) collect.consumer = pixels_.get();
  return collect;
}

std::vector<CollectedFrame> FilmRenderer::FramesOfCollector() {
  std::vector<CollectedFrame> collected;
  if (!film_.HasPlates()) return collected;
  for (Frame& frame : frames_) {
    collected.push_back(CollectedInto(&frame.plate, frame));
    if (film_.MeasuresNoise()) collected.back().moments = &frame.moments;
  }
  return collected;
}

CollectedFrame FilmRenderer::CollectedInto(SensorPlate* plate, const Frame& frame) const {
  const FrameLens& first = frame.lenses.front();
  CollectedFrame collected{first.camera(), plate, frame.ranks, WeightsIn(first)};
  for (const FrameLens& lens : std::span(frame.lenses).subspan(1))
    collected.further.push_back({lens.camera(), WeightsIn(lens)});
  collected.correction = frame.correction;
  if (setup_.is_guarded()) collected.guard = GuardOf(frame);
  return collected;
}

FrameGuard FilmRenderer::GuardOf(const Frame& frame) const {
  FrameGuard guard;
  guard.camera = frame.all_lens->camera();
  guard.weights = [&frame](LfImageId id) { return frame.all_lens->WeightsOf(id); };
  guard.camera_distance_w = frame.lenses.front().camera_distance_w();
  if (film_.lens_weights == LensWeights::kNone)
    guard.camera_distance_w = setup_.package().RecordedCameraDistance(frame.id).value_or(
        CameraDistanceAround(counted_index(), guard.camera));
  return guard;
}

SensorPlate FilmRenderer::EmptyPlateOf(const Frame& frame) const {
  const Intrinsics& plate = frame.lenses.front().camera().pinhole.intrinsics;
  return {plate.width_px, plate.height_px,
          PlateKindOf(setup_.light_field().encoding, setup_.is_guarded())};
}

Result<void> FilmRenderer::PreparePlates(const RunState* state) {
  // All threads make plates at the same time, because a thread that clears a plate mostly waits for
  // the memory.
  setup_.pool().ForEach(frames_.size(), [this](size_t f) {
    Frame& frame = frames_[f];
    if (!setup_.work().IsStopped() && !frame.is_released) frame.plate = EmptyPlateOf(frame);
  });
  for (size_t f = 0; f < frames_.size(); ++f) {
    Frame& frame = frames_[f];
    if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    if (frame.is_released) {
      frame.ranks.begin = frame.ranks.end;
      continue;
    }
    LF_ASSIGN_OR_RETURN(const FrameProgress start, LoadPlate(&frame, state));
    if (film_.Collects()) {  // otherwise EndEarlyFrames() decides, by the rays in memory
      if (frame.is_early) frame.is_early = LacksRays(f, start.ranks_done);
      if (frame.is_early) frame.ranks.end = std::min(frame.ranks.end, start.ranks_done);
    }
    frame.ranks.begin = start.ranks_done;
    frame.earlier_rays = start.rays;
  }
  return {};
}

// Returns true if the earlier run, which has done all LF images before ranks_done, has left LF
// images that have rays for the frame. Such a frame is cut short if it is finished now. A frame
// that has all its rays, for example if its development was interrupted, is finished as usual.
bool FilmRenderer::LacksRays(size_t f, uint32_t ranks_done) const {
  const Frame& frame = frames_[f];
  std::vector<TakingFrame> taking;
  if (film_.Collects()) {
    taking = TakingInstants(frame);
    if (frame.all_lens) taking.push_back(Taking(frame, *frame.all_lens));
    for (TakingFrame& instant : taking) instant.ranks = {ranks_done, frame.ranks.end};
  }
  if (const RenderCamera* const reached = rebinned_ ? rebinned_->ReachedCamera(f) : nullptr)
    taking.push_back({*reached, {rebinned_->ranks_done(), frame.ranks.end}});
  if (pixels_) {
    std::vector<TakingFrame> of_kept = film_.Collects() ? TakingGaps(frame) : TakingInstants(frame);
    if (!film_.Collects() && frame.all_lens) of_kept.push_back(Taking(frame, *frame.all_lens));
    for (TakingFrame& kept : of_kept) {
      kept.ranks = {pixels_->ranks_done(), frame.ranks.end};
      taking.push_back(std::move(kept));
    }
  }
  return !SelectImages(setup_.index(), taking, select_, setup_.pool()).empty();
}

// Loads a plate of the earlier run. If noise is measured and the plate has no moments, the plate is
// dropped and its frame starts again, unless the frame is to be finished early.
Result<FrameProgress> FilmRenderer::LoadPlate(Frame* frame, const RunState* state) const {
  SensorPlate& plate = frame->plate;
  const int width = plate.width(), height = plate.height();
  FrameProgress start;
  std::optional<NoiseMoments> moments;
  if (state != nullptr) {
    LF_ASSIGN_OR_RETURN(
        start, state->LoadPlate(frame->id, &plate, film_.MeasuresNoise() ? &moments : nullptr));
  }
  if (!film_.MeasuresNoise()) return start;
  frame->has_noise = moments || start.ranks_done == 0;
  if (!frame->has_noise && !frame->is_early) {
    LogInfo("frame {} is started again, because its noise was not measured before",
            frame->id.value);
    plate = EmptyPlateOf(*frame);
    start = {};
    frame->has_noise = true;
  }
  frame->moments = moments ? *std::move(moments) : NoiseMoments(width, height);
  return start;
}

// Checks that the frame needs no LF camera farther from its lens than the default options reach,
// because the package contains no farther ones.
Result<void> FilmRenderer::CheckReach(const LensGaps& gaps, FrameId frame) const {
  const std::optional<FrameSampling> sampling = SamplingOf(setup_.package(), frame);
  if (!sampling || !gaps.asks_in_the_end()) return {};
  const RenderCamera& camera = setup_.path().Camera(frame);
  const double reached_w = gaps.ReachedCamera().aperture.radius_w - camera.aperture.radius_w;
  const double known_w = NeighbourReach_w(camera, *sampling);
  if (reached_w <= known_w * (1 + 1e-9)) return {};
  return UsageError(
      fmt::format("{{sigma_st}}, {{lens_points}}: with these options frame {} needs LF cameras up "
                  "to {:.3g} world "
                  "units beside its lens, but package {} contains them only up to {:.3g}: leave "
                  "the options out, or render from the light field instead of packages",
                  frame.value, reached_w, setup_.package().name, known_w));
}

Result<void> FilmRenderer::PrepareRebinning(const RunState* state) {
  std::vector<RebinnedFrame> rebinned;
  for (const Frame& frame : frames_) {
    if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    CollectedWeights collected;
    if (film_.Collects())
      collected = [&frame](LfImageId image) { return frame.lenses.front().WeightsOf(image); };
    LensGaps gaps(setup_.index(), setup_.path().Camera(frame.id), collected,
                  !film_.Collects() || frame.lenses.front().tests_opening(), frame.ranks, select_,
                  film_.rebin.query, setup_.pool(), setup_.package().CameraDistance(frame.id));
    LF_RETURN_IF_ERROR(CheckReach(gaps, frame.id));
    rebinned.push_back({frame.id, std::move(gaps)});
  }
  RebinSettings options = film_.rebin;
  options.max_cells = setup_.max_cells();
  options.is_reference = film_.back_end == CollectBackEnd::kReference;
  rebinned_ = std::make_unique<RebinnedRays>(setup_.index(), setup_.slabs(), std::move(rebinned),
                                             film_.Collects(), select_, options, setup_.pool());
  for (const std::string& line : rebinned_->Describe()) LogInfo("{}", line);
  for (size_t i = 0; state != nullptr && i < rebinned_->section_count(); ++i) {
    LF_ASSIGN_OR_RETURN(
        std::optional<RunState::Rays> rays,
        state->LoadRays(id(0), i, RaysFrames(), rebinned_->max_cells_per_section(), setup_.pool()));
    if (rays) rebinned_->Restore(i, std::move(rays->map), rays->ranks_done);
  }
  return {};
}

// Selects the LF images to load (images_). SelectedImage::rect bounds the pixels that are collected
// into plates; it is empty for an LF image that is only rebinned. RebinnedRays names the pixels to
// rebin only when an LF image is loaded (ImageConsumer::RectOf()).
void FilmRenderer::SelectForFrames() {
  images_.clear();
  if (film_.HasPlates()) {
    SelectOptions select = select_;
    select.whole_images = setup_.work().whole_images;
    std::vector<TakingFrame> taking;
    for (const Frame& frame : frames_) {
      for (TakingFrame& instant : TakingInstants(frame)) taking.push_back(std::move(instant));
      if (frame.all_lens) taking.push_back(Taking(frame, *frame.all_lens));
    }
    images_ = SelectImages(setup_.index(), taking, select, setup_.pool());
  }
  if (film_.shard)
    std::erase_if(images_,
                  [this](const SelectedImage& image) { return !film_.shard->Holds(image.rank); });
  if (rebinned_) AddRebinnedImages();
  if (pixels_) AddKeptImages();
}

void FilmRenderer::AddRebinnedImages() {
  std::vector<TakingFrame> taking;
  for (size_t f = 0; f < frames_.size(); ++f)
    if (const RenderCamera* const reached = rebinned_->ReachedCamera(f))
      taking.push_back({*reached, {rebinned_->ranks_done(), frames_[f].ranks.end}});
  const auto is_before = [](const SelectedImage& a, const SelectedImage& b) {
    return a.rank < b.rank;
  };
  std::vector<SelectedImage> all;
  const std::vector<SelectedImage> asked =
      SelectImages(setup_.index(), taking, select_, setup_.pool());
  for (SelectedImage image : asked) {
    if (std::binary_search(images_.begin(), images_.end(), image, is_before)) continue;
    if (rebinned_->RectOf(image.id, image.rank).empty()) continue;
    image.rect = {};  // none of its pixels is collected
    all.push_back(image);
  }
  const auto middle = all.insert(all.end(), images_.begin(), images_.end());
  std::inplace_merge(all.begin(), middle, all.end(), is_before);
  images_ = std::move(all);
}

// With kRebin, the earlier run kept only rebinned rays for the picture of a frame. If it kept none,
// or all of them, the frame is not finished early.
void FilmRenderer::EndEarlyFrames() {
  if (film_.Collects()) return;
  const uint32_t ranks_done = RebinnedRanksDone();
  for (size_t f = 0; f < frames_.size(); ++f) {
    Frame& frame = frames_[f];
    if (!frame.is_early || frame.is_released) continue;
    frame.is_early = ranks_done > 0 && LacksRays(f, ranks_done);
    if (frame.is_early) frame.ranks.end = ranks_done;
  }
}

Result<bool> FilmRenderer::Step() {
  const Result<bool> step = collector_->Step();
  if (!step && step.error().kind != ErrorKind::kInterrupted) return step;
  if (pixels_) LF_RETURN_IF_ERROR(CheckRoom());
  DecideStops();
  for (; done_.image_count < collector_->images_done(); ++done_.image_count)
    done_.tested_count += images_[done_.image_count].ray_count;
  return step;
}

CollectProgress FilmRenderer::total() const {
  CollectProgress total = {images_.size(), 0};
  for (const SelectedImage& image : images_) total.tested_count += image.ray_count;
  return total;
}

FrameProgress FilmRenderer::Progress(size_t f) const {
  if (!film_.HasPlates()) return {RebinnedRanksDone(), frames_[f].kept_rays};
  FrameProgress progress = collector_->frames()[f].progress;
  if (frames_[f].is_stopped) progress.ranks_done = frames_[f].next_decision;
  progress.rays += frames_[f].earlier_rays;
  return progress;
}

uint32_t FilmRenderer::RankOfEnd(size_t f) const {
  const Frame& frame = frames_[f];
  return frame.is_stopped ? frame.next_decision
                          : std::min(frame.ranks.end, setup_.index().rank_end());
}

// A frame that has all LF images that it takes is completed as at the end of the render
// (kInTheEnd), even if it takes only a part of the light field. A frame that was stopped or is
// finished early is completed at its last rank. It has more gaps, because the LF images after this
// rank do not cover them.
Result<std::optional<Completion>> FilmRenderer::Complete(size_t f, bool with_plate) {
  if (!rebinned_ && !pixels_) return std::optional<Completion>();
  const uint32_t done = Progress(f).ranks_done;
  if (CollectsKept()) {
    LF_RETURN_IF_ERROR(CollectKept(&frames_[f], done));
    return std::optional<Completion>();
  }
  if (pixels_) {
    LF_ASSIGN_OR_RETURN(PlateGaps gaps, CollectGaps(frames_[f], done));
    if (!with_plate) return std::optional(CompletionOf(gaps.rays, std::move(gaps.share)));
    frames_[f].kept_gaps = std::move(gaps);
    if (film_.shard) return std::optional<Completion>();
    return std::optional(CompletionOf(frames_[f].kept_gaps->rays, frames_[f].kept_gaps->share));
  }
  const bool is_all =
      !frames_[f].is_early && done >= std::min(frames_[f].ranks.end, setup_.index().rank_end());
  return std::optional(rebinned_->Complete(f, is_all ? LensGaps::kInTheEnd : done));
}

Result<RenderedFrame> FilmRenderer::Develop(size_t f) {
  LF_ASSIGN_OR_RETURN(const std::optional<Completion> completion, Complete(f, false));
  return Develop(f, completion, true, {});
}

RenderedFrame FilmRenderer::Develop(size_t f, const std::optional<Completion>& completion,
                                    bool with_effective,
                                    const std::function<bool()>& is_interrupted) const {
  const auto develop = [&](const SensorPlate& plate) {
    return DevelopFrame(NotesOf(f), plate, completion ? &*completion : nullptr, with_effective,
                        setup_.pool(), is_interrupted);
  };
  if (film_.Collects() || pixels_) return develop(PictureOf(f));
  const Intrinsics& plate = lenses(f).front().camera().pinhole.intrinsics;
  // The plate is empty, because the whole picture is interpolated.
  return develop(SensorPlate(plate.width_px, plate.height_px));
}

PlateNotes FilmRenderer::NotesOf(size_t f) const {
  const FrameId id = frames_[f].id;
  PlateNotes notes = MakePlateNotes(id, setup_.path().Camera(id),
                                    film_.Collects() ? Progress(f).rays : frames_[f].kept_rays,
                                    lenses(f), setup_.light_field().encoding);
  notes.fps = setup_.path().fps;
  notes.first_frame = setup_.path().first_frame;
  notes.shutter = ShutterOf(setup_.path(), id);
  notes.estimator = film_.reading.estimator;
  notes.develop.smooth_below = film_.smooth_below;
  notes.develop.fill_radius_px = film_.fill_radius_px;
  notes.develop.adds_opacity = film_.adds_opacity;
  if (frames_[f].is_early) notes.ranks_done = frames_[f].ranks.end;
  return notes;
}

void FilmRenderer::ForgetPicture(size_t f) {
  frames_[f].kept_plate = SensorPlate(0, 0);
  frames_[f].kept_gaps.reset();
}

void FilmRenderer::Release(size_t f) {
  Frame& frame = frames_[f];
  frame.is_released = true;
  ForgetPicture(f);
  if (!film_.HasPlates()) return;
  collector_->Stop(f);
  frame.plate = SensorPlate(0, 0);
  frame.moments = NoiseMoments();
}

Result<void> FilmRenderer::CheckAnyContributes() const {
  const bool has_rays = std::any_of(frames_.begin(), frames_.end(), [](const Frame& frame) {
    return frame.earlier_rays.accepted_count > 0;
  });
  if (!images_.empty() || has_rays) return {};
  std::vector<FrameId> ids;
  for (const Frame& frame : frames_) ids.push_back(frame.id);
  return NoneContributes(ids);
}

bool FilmRenderer::AllBroken() const {
  if (collector_->skipped().size() != images_.size()) return false;
  return std::none_of(frames_.begin(), frames_.end(),
                      [](const Frame& frame) { return frame.earlier_rays.accepted_count > 0; });
}

}  // namespace lf
