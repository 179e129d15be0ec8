#include "lf/pipeline/render_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "lf/capture/value_hasher.h"
#include "lf/core/log.h"
#include "lf/hybrid/frame_sampling.h"
#include "lf/pipeline/skipped_images.h"
#include "lf/preprocess/frame_needs.h"

namespace lf {
SelectOptions RenderJob::Select() const {
  SelectOptions select;
  select.reach = ReachOf(options.reading.estimator);
  select.max_angle_rad = package.choices.max_angle_rad;
  if (options.signals != nullptr) select.interrupted = &options.signals->stop;
  return select;
}

RenderPass::RenderPass(const RenderJob& job, std::span<const FrameId> frames,
                       std::span<const FrameId> early)
    : job_(job) {
  for (const FrameId frame : frames) {
    frames_.push_back({});
    frames_.back().id = frame;
    frames_.back().is_finished = job.state.finished().contains(frame);
    frames_.back().is_early = std::binary_search(early.begin(), early.end(), frame);
  }
}

void RenderPass::FindLenses() {
  for (const Frame& frame : frames_) {
    if (job_.IsStopped()) return;
    lenses_.emplace_back(job_.index, job_.path.Camera(frame.id), job_.options.lens_weights,
                         job_.Select(), job_.pool, job_.package.CameraDistance(frame.id));
    cameras_.push_back(lenses_.back().camera());
  }
}

// Selects the LF images with rays that count in a frame of this pass.
SelectOptions RenderPass::SelectCollected() const {
  SelectOptions select = job_.Select();
  if (job_.options.lens_weights != LensWeights::kNone)
    select.takes = [this](size_t f, LfImageId id) { return lenses_[f].Takes(id); };
  return select;
}

Result<void> RenderPass::Prepare() {
  FindLenses();
  if (job_.IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  std::vector<PlaceRange> places(frames_.size());
  if (job_.options.max_image_count)
    places = PlacesOfFirst(*job_.options.max_image_count, job_.index, cameras_, SelectCollected(),
                           job_.pool);
  if (job_.Rebins()) LF_RETURN_IF_ERROR(PrepareRebinning(places));
  if (job_.HasPlates()) LF_RETURN_IF_ERROR(PreparePlates(&places));
  if (rebinned_ && HasStopRule()) ForgetRaysAhead(places);
  SelectForPass(places);
  if (job_.IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  job_.totals.selected_image_count = std::max(job_.totals.selected_image_count, images_.size());

  CollectOptions collect;
  collect.reading = job_.options.reading;
  collect.back_end = job_.options.back_end;
  collect.batch_image_count = static_cast<int>(job_.plan.batch_image_count);
  collect.plan_bytes = job_.plan.plan_bytes;
  collect.strict = job_.options.strict;
  collect.whole_images = job_.options.whole_images;
  if (job_.options.signals != nullptr) collect.interrupted = &job_.options.signals->attention;
  collect.place_end = job_.index.place_end();
  if (job_.options.lens_weights != LensWeights::kNone || job_.package.choices.max_angle_rad)
    collect.weights = [this](size_t f, LfImageId id) { return lenses_[f].WeightsOf(id); };
  collect.decision_places = 0;
  if (rebinned_) {
    collect.taker = rebinned_.get();
    collect.decision_places = kDecisionPlaces;
  }
  if (HasStopRule()) LF_RETURN_IF_ERROR(PrepareStops(places, &collect));
  if (job_.options.MeasuresNoise()) collect.moments = &moments_;
  const auto collected =
      job_.HasPlates() ? std::span<const RenderCamera>(cameras_) : std::span<const RenderCamera>();
  collector_ = std::make_unique<FrameCollector>(
      job_.package.light_field, job_.store, collected, images_,
      job_.HasPlates() ? std::span<const PlaceRange>(places) : std::span<const PlaceRange>(),
      collect, job_.pool, &plates_);
  for (size_t f = 0; f < collected.size(); ++f)
    if (frames_[f].is_finished) collector_->Stop(f);
  return {};
}

Result<void> RenderPass::PreparePlates(std::vector<PlaceRange>* places) {
  // Plates are made by all threads, because a thread that clears one waits for its memory.
  for (size_t f = 0; f < frames_.size(); ++f) plates_.emplace_back(0, 0);
  if (job_.options.MeasuresNoise()) moments_.resize(frames_.size());
  job_.pool.ForEach(frames_.size(), [this](size_t f) {
    const Intrinsics& plate = cameras_[f].pinhole.intrinsics;
    if (!job_.IsStopped() && !frames_[f].is_finished)
      plates_[f] = SensorPlate::WithOpacity(plate.width_px, plate.height_px,
                                            job_.package.light_field.encoding.HasOpacity());
  });
  for (size_t f = 0; f < frames_.size(); ++f) {
    if (job_.IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    Frame& frame = frames_[f];
    PlaceRange& taken = (*places)[f];
    if (frame.is_finished) {
      taken.begin = taken.end;
      continue;
    }
    LF_ASSIGN_OR_RETURN(const FrameProgress start, LoadPlate(f));
    if (frame.is_early) taken.end = std::min(taken.end, start.places_done);
    frame.places = {0, taken.end};
    taken.begin = start.places_done;
    frame.earlier_rays = start.rays;
    frame.saved_places = start.places_done;
  }
  return {};
}

// Loads a plate of an earlier run. If noise is measured, a plate without moments is dropped, and
// its frame begins anew, unless the frame is finished early.
Result<FrameProgress> RenderPass::LoadPlate(size_t f) {
  Frame& frame = frames_[f];
  if (!job_.options.MeasuresNoise()) return job_.state.LoadPlate(frame.id, &plates_[f]);
  const int width = plates_[f].width(), height = plates_[f].height();
  std::optional<NoiseMoments> moments;
  LF_ASSIGN_OR_RETURN(FrameProgress start, job_.state.LoadPlate(frame.id, &plates_[f], &moments));
  frame.has_noise = moments || start.places_done == 0;
  if (!frame.has_noise && !frame.is_early) {
    LogInfo("frame {} is begun anew, since its noise was not measured before", frame.id.value);
    plates_[f] = SensorPlate::WithOpacity(width, height, plates_[f].has_opacity());
    start = {};
    frame.has_noise = true;
  }
  moments_[f] = moments ? *std::move(moments) : NoiseMoments(width, height);
  return start;
}

// Checks that the frame needs no LF cameras beyond the reach of the default options, because the
// package has no others.
Result<void> RenderPass::CheckReach(const LensGaps& gaps, FrameId frame) const {
  if (job_.package.surroundings.empty() || !gaps.asks_in_the_end()) return {};
  const RenderCamera& camera = job_.path.Camera(frame);
  const double reached_w = gaps.ReachedCamera().aperture.radius_w - camera.aperture.radius_w;
  const double known_w =
      NeighbourReach_w(camera, SamplingOf(job_.package.surroundings[frame.value - 1]));
  if (reached_w <= known_w * (1 + 1e-9)) return {};
  return UsageError(fmt::format(
      "--sigma-st, --lens-points: frame {} asks for rays up to {:.3g} world units beside its lens, "
      "and {} has LF cameras up to {:.3g}: leave them out, or render the light field itself",
      frame.value, reached_w, job_.package.name, known_w));
}

Result<void> RenderPass::PrepareRebinning(std::span<const PlaceRange> places) {
  std::vector<LensGaps> gaps;
  std::vector<FrameId> ids;
  for (size_t f = 0; f < frames_.size(); ++f) {
    if (job_.IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    const FrameId id = frames_[f].id;
    CollectedWeights collected;
    if (job_.Collects())
      collected = [&, f](LfImageId image) { return lenses_[f].WeightsOf(image); };
    gaps.emplace_back(job_.index, job_.path.Camera(id), collected,
                      job_.options.lens_weights == LensWeights::kNone, places[f], job_.Select(),
                      job_.options.rebin.query, job_.pool, job_.package.CameraDistance(id));
    LF_RETURN_IF_ERROR(CheckReach(gaps.back(), id));
    ids.push_back(id);
  }
  RebinPassOptions options = job_.options.rebin;
  options.max_cells = job_.max_cells;
  options.is_reference = job_.options.back_end == CollectBackEnd::kReference;
  rebinned_ = std::make_unique<RebinnedRays>(job_.index, *job_.slabs, ids, std::move(gaps), places,
                                             job_.Collects(), job_.Select(), options, job_.pool);
  for (const std::string& line : rebinned_->Describe()) LogInfo("{}", line);
  ValueHasher numbers;
  for (const Frame& frame : frames_) numbers.Add(frame.id.value);
  rays_frames_ = fmt::format("{} from {} to {} ({})", frames_.size(), frames_.front().id.value,
                             frames_.back().id.value, numbers.Text());
  saved_rays_places_.assign(rebinned_->section_count(), 0);
  for (size_t i = 0; i < rebinned_->section_count(); ++i) {
    LF_ASSIGN_OR_RETURN(std::optional<RunState::Rays> rays,
                        job_.state.LoadRays(frames_.front().id, i, rays_frames_,
                                            rebinned_->max_cells_per_section(), job_.pool));
    if (!rays) continue;
    saved_rays_places_[i] = rays->places_done;
    rebinned_->Restore(i, std::move(rays->map), rays->places_done);
  }
  return {};
}

// Selects the LF images of the pass. Images for plates have the rectangle of the pixels to collect;
// rebinned rays name their pixels when an image is loaded (ImageTaker).
void RenderPass::SelectForPass(std::span<const PlaceRange> places) {
  images_.clear();
  if (job_.HasPlates()) {
    SelectOptions select = SelectCollected();
    select.whole_images = job_.options.whole_images;
    images_ = SelectImages(job_.index, cameras_, select, job_.pool, places);
  }
  if (job_.options.shard)
    std::erase_if(images_, [this](const SelectedImage& image) {
      return !job_.options.shard->Holds(image.place);
    });
  if (rebinned_) AddRebinnedImages(places);
}

void RenderPass::AddRebinnedImages(std::span<const PlaceRange> places) {
  std::vector<PlaceRange> taken;
  for (const size_t f : rebinned_->asking_frames())
    taken.push_back({rebinned_->places_done(), places[f].end});
  const auto is_before = [](const SelectedImage& a, const SelectedImage& b) {
    return a.place < b.place;
  };
  std::vector<SelectedImage> all;
  const std::vector<SelectedImage> asked =
      SelectImages(job_.index, rebinned_->ReachedCameras(), job_.Select(), job_.pool, taken);
  for (SelectedImage image : asked) {
    if (std::binary_search(images_.begin(), images_.end(), image, is_before)) continue;
    if (rebinned_->RectOf(image.id, image.place).empty()) continue;
    image.rect = {};  // nothing is collected of it
    all.push_back(image);
  }
  const auto middle = all.insert(all.end(), images_.begin(), images_.end());
  std::inplace_merge(all.begin(), middle, all.end(), is_before);
  images_ = std::move(all);
}

Result<void> RenderPass::Collect() {
  LF_RETURN_IF_ERROR(FinishEarlyFrames());
  // An earlier run may have left frames at a place where the stop rule decides.
  LF_RETURN_IF_ERROR(DecideStops());
  while (!AreAllFinished()) {
    const Result<bool> step = collector_->Step();
    if (!step && step.error().kind != ErrorKind::kInterrupted) {
      // Plates are complete up to the last step, so that they can be saved.
      if (!Save(0)) return step.error();
      return Error{step.error().kind,
                   step.error().message + " (what is done is kept: --resume goes on)"};
    }
    LF_RETURN_IF_ERROR(DecideStops());
    for (; done_.image_count < collector_->images_done(); ++done_.image_count)
      done_.tested_count += images_[done_.image_count].ray_count;
    job_.progress(done_, finished_count_);
    if (job_.IsStopped()) return Interrupt();
    if (!step) job_.options.signals->attention = false;
    if (job_.options.signals != nullptr && job_.options.signals->save.exchange(false)) {
      LF_RETURN_IF_ERROR(Save(std::numeric_limits<double>::infinity()));
      LogInfo("the state is written, as the signal asked for");
    }
    if (step && !*step) return {};
    LF_RETURN_IF_ERROR(SaveWhenDue());
  }
  return {};
}

// Finishes the early frames at once: the state has all rays that they will get.
Result<void> RenderPass::FinishEarlyFrames() {
  for (size_t f = 0; f < frames_.size(); ++f) {
    Frame& frame = frames_[f];
    if (!frame.is_early || frame.is_finished) continue;
    if (!job_.Collects()) {
      const uint32_t places_done = rebinned_->places_done();
      if (places_done == 0) {
        LogWarning("--finish: frame {} has no rays yet: it takes all of its LF images",
                   frame.id.value);
        frame.is_early = false;
        continue;
      }
      frame.places.end = places_done;
    }
    LF_RETURN_IF_ERROR(FinishFrames({&f, 1}));
  }
  return {};
}

bool RenderPass::AllBroken() const {
  if (collector_->skipped().size() != images_.size()) return false;
  return std::none_of(frames_.begin(), frames_.end(),
                      [](const Frame& frame) { return frame.earlier_rays.accepted_count > 0; });
}

Result<void> RenderPass::Finish() {
  LF_RETURN_IF_ERROR(job_.state.SaveTotals(Totals()));
  std::vector<size_t> left;
  for (size_t f = 0; f < frames_.size(); ++f)
    if (!frames_[f].is_finished) left.push_back(f);
  for (size_t begin = 0; begin < left.size();) {
    if (job_.IsStopped()) return Interrupt();
    const size_t count = std::min(job_.plan.frames_finished_at_once, left.size() - begin);
    const auto together = std::span(left).subspan(begin, count);
    LF_RETURN_IF_ERROR(FinishFrames(together));
    if (job_.HasPlates())
      for (const size_t f : together) plates_[f] = SensorPlate(0, 0);
    begin += count;
  }
  if (rebinned_ && rebinned_->facts().is_too_coarse)
    LogWarning(
        "cells of rebinned rays are so wide that some got more LF pixels than they have room for: "
        "make --r-st or --r-uv smaller");
  if (rebinned_) job_.state.RemoveRays();
  const double earlier_s = job_.totals.total_s;
  job_.totals = Totals();
  job_.totals.total_s = earlier_s;
  return {};
}

// Returns the progress of a frame with all rays in its plate, those of earlier runs included.
FrameProgress RenderPass::ProgressOf(size_t f) const {
  if (!job_.HasPlates()) return {rebinned_->places_done(), {}};
  FrameProgress progress = collector_->frames()[f];
  if (frames_[f].is_stopped) progress.places_done = frames_[f].next_decision;
  const FrameRays& earlier = frames_[f].earlier_rays;
  progress.rays.image_count += earlier.image_count;
  progress.rays.tested_count += earlier.tested_count;
  progress.rays.accepted_count += earlier.accepted_count;
  return progress;
}

// Writes frames at the same time, because an encoder keeps only one thread busy. A frame that is
// written is kept, even if another one fails.
Result<void> RenderPass::FinishFrames(std::span<const size_t> frames) {
  std::vector<std::optional<Result<FrameReport>>> written(frames.size());
  const std::vector<Completion> completions = Complete(frames);
  job_.pool.ForEach(frames.size(), [&](size_t i) {
    written[i].emplace(WriteFiles(frames[i], completions.empty() ? nullptr : &completions[i]));
  });
  for (size_t i = 0; i < frames.size(); ++i)
    if (*written[i]) LF_RETURN_IF_ERROR(Conclude(frames[i], **written[i]));
  for (const std::optional<Result<FrameReport>>& result : written)
    if (!*result && result->error().kind != ErrorKind::kInterrupted) return result->error();
  for (const std::optional<Result<FrameReport>>& result : written)
    if (!*result) return Interrupt();
  return {};
}

FrameSheet RenderPass::SheetOf(size_t f) const {
  FrameSheet sheet = MakeFrameSheet(frames_[f].id, job_.path.Camera(frames_[f].id),
                                    job_.Collects() ? ProgressOf(f).rays : FrameRays(), lenses_[f],
                                    job_.package.light_field.encoding);
  sheet.fps = job_.path.fps;
  sheet.estimator = job_.options.reading.estimator;
  sheet.version = job_.options.version;
  sheet.develop.smooth_below = job_.options.smooth_below;
  sheet.develop.fill_radius_px = job_.options.fill_radius_px;
  if (frames_[f].is_early) sheet.places_done = frames_[f].places.end;
  return sheet;
}

// Writes the files of a frame. May be called by several threads at the same time, for different
// frames.
Result<FrameReport> RenderPass::WriteFiles(size_t f, const Completion* completion) {
  Frame& frame = frames_[f];
  FrameProgress progress = ProgressOf(f);
  const std::filesystem::path to = job_.state.FinishedPath(frame.id);
  if (job_.options.keep_plates || job_.options.shard) {
    // The place where a frame ends must not depend on passes.
    progress.places_done =
        frame.is_stopped ? frame.next_decision : std::min(frame.places.end, job_.index.place_end());
    std::filesystem::path plate = to;
    PlateEntries text =
        job_.state.PlateText(frame.id, progress, frame.has_noise ? &moments_[f] : nullptr);
    FrameSheet sheet = SheetOf(f);
    sheet.skipped =
        SkippedOf(Totals().skipped, job_.index,
                  {lenses_[f], {0, progress.places_done}, job_.Select().reach, job_.options.shard});
    sheet.skipped_count = sheet.skipped.size();
    for (auto& entry : TextOf(sheet)) text.push_back(std::move(entry));
    if (job_.options.shard) text.emplace_back("shard", job_.options.shard->Text());
    LF_RETURN_IF_ERROR(WritePlate(plate.replace_extension(".plate"), text, plates_[f], job_.pool));
  }
  if (job_.options.shard) {
    FrameReport report;
    report.frame = frame.id;
    report.rays = progress.rays;
    report.camera = InputsOfCamera(frame.id, job_.path.Camera(frame.id));
    return report;
  }
  LF_ASSIGN_OR_RETURN(FrameReport report,
                      WritePicture(f, completion, to, [this] { return job_.IsStopped(); }));
  LF_RETURN_IF_ERROR(Measure(f, &report));
  return report;
}

Result<FrameReport> RenderPass::WritePicture(size_t f, const Completion* completion,
                                             const std::filesystem::path& to,
                                             const std::function<bool()>& is_interrupted) {
  const Intrinsics& plate = cameras_[f].pinhole.intrinsics;
  const SensorPlate none =
      job_.Collects() ? SensorPlate(0, 0) : SensorPlate(plate.width_px, plate.height_px);
  return lf::WritePicture(SheetOf(f), job_.Collects() ? plates_[f] : none, completion, to,
                          job_.options.format, job_.pool, is_interrupted);
}

// A frame with all LF images that it takes is in its final state, even if it takes only some. A
// frame that was stopped, or is finished early, has more gaps, which no later LF image covers.
std::vector<Completion> RenderPass::Complete(std::span<const size_t> frames) {
  std::vector<Completion> completions;
  if (!rebinned_) return completions;
  for (const size_t f : frames) {
    const uint32_t done = ProgressOf(f).places_done;
    const bool is_all =
        !frames_[f].is_early && done >= std::min(frames_[f].places.end, job_.index.place_end());
    completions.push_back(rebinned_->Complete(f, is_all ? LensGaps::kInTheEnd : done));
  }
  return completions;
}

Result<void> RenderPass::Conclude(size_t f, const FrameReport& report) {
  Frame& frame = frames_[f];
  if (!job_.options.shard && report.rays.image_count == 0 &&
      report.interpolated_share.value_or(0) == 0) {
    // Only the first black frames are logged; a report has all of them.
    constexpr size_t kTold = 10;
    if (++job_.black_count <= kTold)
      LogWarning("frame {} is black: no LF image contributes to it", frame.id.value);
    if (job_.black_count == kTold + 1)
      LogWarning("more frames are black; report.json has the LF images of every frame");
  }
  LF_RETURN_IF_ERROR(job_.state.SaveFinished(report));
  LogDebug("frame {}: written, with {} rays of {} LF images", frame.id.value,
           report.rays.accepted_count, report.rays.image_count);
  frame.is_finished = true;
  ++finished_count_;
  job_.progress(done_, finished_count_);
  return {};
}

// Returns the totals with the work of this pass so far.
RenderReport RenderPass::Totals() const {
  RenderReport totals = job_.totals;
  totals.total_s += NowSeconds() - job_.begin_s;
  totals.load_cpu_s += collector_->times().load_cpu_s;
  totals.load_wall_s += collector_->times().load_wall_s;
  totals.collect_cpu_s += collector_->times().collect_cpu_s;
  if (rebinned_) {
    const RebinnedRays::Facts facts = rebinned_->facts();
    RebinReport& rebinning = totals.rebinning ? *totals.rebinning : totals.rebinning.emplace();
    rebinning.slab_count = std::max(rebinning.slab_count, facts.section_count);
    rebinning.cell_count = std::max<uint64_t>(rebinning.cell_count, facts.cell_count);
    rebinning.looked_at_count += facts.looked_at;
    rebinning.cpu_s += facts.cpu_s;
    if (facts.is_full)
      rebinning.kept = "some";
    else if (!facts.keeps_all && rebinning.kept == "all")
      rebinning.kept = "edges";
  }
  totals.AddSkipped(collector_->skipped());
  return totals;
}

}  // namespace lf
