// SPDX-License-Identifier: Apache-2.0
// The parts of FilmRenderer that stop frames by a rule, and measure finished frames.
#include <algorithm>
#include <cmath>

#include "lf/core/log.h"
#include "lf/render/collect/noise_rule.h"
#include "lf/render/pipeline/film_renderer.h"

namespace lf {

const ReachableElements& FilmRenderer::ReachableOf(size_t f) {
  Frame& frame = frames_[f];
  if (!frame.reachable) {
    for (const FrameLens& lens : frame.lenses) {
      ImageWeights weights;
      if (film_.lens_weights != LensWeights::kNone || setup_.is_guarded())
        weights = [&lens](LfImageId id) { return lens.WeightsOf(id); };
      auto reachable = std::make_unique<ReachableElements>(counted_index(), lens.camera(),
                                                           RankRange{0, frame.ranks.end}, select_,
                                                           film_.reading, setup_.pool(), weights);
      if (frame.reachable)
        frame.reachable->Join(*reachable);
      else
        frame.reachable = std::move(reachable);
    }
  }
  return *frame.reachable;
}

// Makes batches end at the ranks where the stop rule of a frame is applied, in addition to the
// ranks that rebinned rays need.
Result<void> FilmRenderer::PrepareStops(CollectOptions* collect) {
  collect->cuts_for_noise = film_.stop_when.noise.has_value();
  for (size_t f = 0; f < frames_.size(); ++f) {
    Frame& frame = frames_[f];
    if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    if (frame.is_released) continue;
    const ReachableElements& reachable = ReachableOf(f);
    if (film_.stop_when.samples) {
      // Batches end at the multiples of the smallest decision_ranks of all frames. The
      // decision_ranks of each frame is a multiple of this smallest one.
      frame.decision_ranks = DecisionRanks(setup_.index().rank_end(), reachable.image_count());
      collect->decision_ranks = collect->decision_ranks == 0
                                    ? frame.decision_ranks
                                    : std::min(collect->decision_ranks, frame.decision_ranks);
    }
    frame.next_decision = DecisionFrom(f, std::max(frame.ranks.begin, 1U));
  }
  if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  return {};
}

// Returns the first rank at or after `rank` where the stop rule of the frame is applied. `rank`
// must be above 0.
uint32_t FilmRenderer::DecisionFrom(size_t f, uint32_t rank) const {
  if (film_.stop_when.noise) return NoiseDecisionAfter(rank - 1);
  const uint32_t step = frames_[f].decision_ranks;
  return (rank + step - 1) / step * step;
}

// A frame that stops must be completed with rebinned rays of exactly the LF images in its plate. In
// a saved state, the rebinned rays may lag behind the plates, which are written first; Step() then
// catches up. If a plate was removed, the rebinned rays are ahead of its frame. This function then
// drops them, so that they are made again from the first LF image.
void FilmRenderer::ForgetRaysAhead() {
  uint32_t least = UINT32_MAX;
  for (const Frame& frame : frames_)
    if (!frame.is_released) least = std::min(least, frame.ranks.begin);
  if (pixels_ && pixels_->ranks_done() > least) {
    LogInfo(
        "pixels are kept again, because they are those of more LF images than a frame has "
        "collected");
    pixels_->Restore(KeptPixels(pixels_->max_pixels()), 0);
  }
  for (size_t i = 0; rebinned_ && i < rebinned_->section_count(); ++i) {
    if (rebinned_->ranks_done(i) <= least) continue;
    LogInfo(
        "rebinned rays are made again, because they were made from more LF images than a frame has "
        "collected");
    rebinned_->Restore(i, RayMap(rebinned_->max_cells_per_section(), 0), 0);
  }
}

// Returns the rank of the first LF image to be loaded at or after ranks_done; rank_end() if
// there is none. A frame that is done up to ranks_done is also done up to the returned rank,
// because no LF image to be loaded lies between.
uint32_t FilmRenderer::RanksCovered(uint32_t ranks_done) const {
  const auto next =
      std::lower_bound(images_.begin(), images_.end(), ranks_done,
                       [](const SelectedImage& image, uint32_t rank) { return image.rank < rank; });
  return next == images_.end() ? setup_.index().rank_end() : next->rank;
}

// Returns the noise of a frame in radiance, with the light field's white as 1; infinity if the
// noise cannot be measured.
double FilmRenderer::NoiseOf(size_t f) {
  return MeasureNoise(frames_[f].plate, frames_[f].moments, ReachableOf(f)) /
         setup_.light_field().encoding.Scale();
}

bool FilmRenderer::IsEnough(size_t f) {
  if (film_.stop_when.noise) return NoiseOf(f) <= *film_.stop_when.noise;
  return HasSamples(frames_[f].plate, ReachableOf(f), *film_.stop_when.samples);
}

// Applies the stop rule to every frame that has reached its next_decision. The plate then has
// exactly the rays of the LF images before this rank, because no batch extends beyond such a
// rank, and ranks without an LF image to be loaded add nothing. Decisions therefore do not depend
// on the LF images that other frames take. If an interrupted earlier run has decided already, the
// decision is the same.
void FilmRenderer::DecideStops() {
  if (!film_.HasStopRule()) return;
  for (size_t f = 0; f < frames_.size(); ++f) {
    Frame& frame = frames_[f];
    // The rule is not applied to a frame that is finished early.
    if (frame.is_released || frame.is_early || frame.is_stopped) continue;
    const uint32_t covered = RanksCovered(collector_->frames()[f].progress.ranks_done);
    if (covered < frame.next_decision) continue;
    // After an interruption, rebinned rays must catch up to the rank where the frame may stop.
    if ((rebinned_ || pixels_) && RanksCovered(RebinnedRanksDone()) < frame.next_decision) continue;
    if (!IsEnough(f)) {
      frame.next_decision = DecisionFrom(f, covered + 1);
      continue;
    }
    LogDebug("frame {}: the stop rule is met at rank {}", frame.id.value, frame.next_decision);
    collector_->Stop(f);
    frame.is_stopped = true;
  }
}

std::vector<size_t> FilmRenderer::StoppedFrames() const {
  std::vector<size_t> stopped;
  for (size_t f = 0; f < frames_.size(); ++f)
    if (frames_[f].is_stopped && !frames_[f].is_released) stopped.push_back(f);
  return stopped;
}

Result<void> FilmRenderer::Measure(size_t f, FrameReport* report) {
  const Frame& frame = frames_[f];
  const auto samples = film_.require.samples ? film_.require.samples : film_.stop_when.samples;
  if (samples)
    report->samples = FrameSamples{*samples, MeasureSamples(frame.plate, ReachableOf(f), *samples)};
  const auto noise = film_.require.noise ? film_.require.noise : film_.stop_when.noise;
  if (noise && frame.has_noise) {
    FrameNoise& measured = report->noise.emplace();
    measured.asked = *noise;
    if (const double reached = NoiseOf(f); std::isfinite(reached)) measured.reached = reached;
    measured.ranks = RankOfEnd(f);
    measured.image_count = Progress(f).rays.image_count;
  }
  if ((samples || noise) && setup_.work().IsStopped())
    return Error{ErrorKind::kInterrupted, "interrupted"};
  return {};
}

}  // namespace lf
