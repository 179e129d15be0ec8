// SPDX-License-Identifier: Apache-2.0
// Renders frames of a film in memory: without folders, files or signals.
//
//   LF_ASSIGN_OR_RETURN(auto renderer, FilmRenderer::Open(package, film, work, {}, pool));
//   for (bool is_going_on = true; is_going_on;) {
//     LF_ASSIGN_OR_RETURN(is_going_on, renderer->Step());  // one batch of LF images
//     Show(renderer->Develop(0).picture);                  // the frame with the rays so far
//   }
//
// Between two steps, every frame has exactly the rays of those LF images that it takes and whose
// ranks in the order are below its FrameProgress::ranks_done. Frames have the same bits however
// the work is divided into batches.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/collect/sample_rule.h"
#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/gap_lens.h"
#include "lf/render/hybrid/lens_gaps.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/pipeline/frame_source.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/report.h"
#include "lf/render/state/run_state.h"

namespace lf {

class FilmRenderer final : public FrameSource {
 public:
  // Makes a renderer of some frames of the package, ready for the first step. The pool must outlive
  // the renderer.
  //   frames  ascending; empty: all frames of the package
  // kOutput: the memory does not suffice for all of the frames at the same time; the message names
  // the number that fits. Other errors are those of FilmSetup::Make(), PlanSlabs() and Begin().
  static Result<std::unique_ptr<FilmRenderer>> Open(Package package, const FilmSettings& film,
                                                    const WorkSettings& work,
                                                    std::vector<FrameId> frames, ThreadPool& pool);

  // FilmSetup::PlanSlabs() must have been called. The setup must outlive the renderer.
  //   frames  some of the setup's frames, ascending; at most plan().frames_per_pass. Which rebinned
  //           rays are kept depends on all of these frames, even on finished ones.
  FilmRenderer(const FilmSetup& setup, std::span<const FrameId> frames);

  // kInterrupted: WorkSettings::stop is set. kUsage: the package lacks LF cameras from whose LF
  // images rebinned rays must be made. Other errors are those of RunState::LoadPlate() and
  // LoadRays().
  Result<void> Begin(const RunState* state = nullptr, std::span<const FrameId> early = {}) override;

  // Collects the next batch of LF images, and stops the frames whose stop rule is met. Errors are
  // those of FrameCollector::Step().
  Result<bool> Step() override;

  size_t frame_count() const override { return frames_.size(); }
  FrameId id(size_t f) const override { return frames_[f].id; }
  // Returns the frame's progress. It counts all rays in the plate, including those of the earlier
  // run.
  FrameProgress Progress(size_t f) const override;
  // Must be called only if FilmSettings::HasPlates() is true.
  const SensorPlate& plate(size_t f) const { return frames_[f].plate; }
  // The rays that the picture of the frame is developed from. With kRebin, they are those of the
  // last call of Complete().
  const SensorPlate& PictureOf(size_t f) const {
    return CollectsKept() ? frames_[f].kept_plate : frames_[f].plate;
  }
  // Returns the noise moments of the plate; null if noise is not measured, or if the moments lack
  // LF images whose rays are in the plate.
  const NoiseMoments* moments(size_t f) const {
    return frames_[f].has_noise ? &frames_[f].moments : nullptr;
  }
  // The lenses of the frame's instants, one without a shutter: of the LF images that the frame's
  // plate has or, if the plate is guarded, of the recorded LF images alone.
  std::span<const FrameLens> lenses(size_t f) const { return frames_[f].lenses; }
  // The lens of all LF images if the plate is guarded; otherwise null.
  const FrameLens* all_lens(size_t f) const {
    return frames_[f].all_lens ? &*frames_[f].all_lens : nullptr;
  }

  bool EndsEarly(size_t f) const override { return frames_[f].is_early; }
  // The frames that the stop rule has stopped.
  std::vector<size_t> StoppedFrames() const override;
  // Returns the end (exclusive) of the frame's ranks in the order: the rank where its stop rule
  // stopped it, otherwise the end of the ranks that the frame takes. Does not depend on how the
  // work is divided into batches.
  uint32_t RankOfEnd(size_t f) const;

  // Interpolates a frame from rebinned rays, or completes it from kept pixels. If the mode is
  // kRebin, collects the frame's plate from kept pixels. Returns nullopt if there is nothing to
  // mix.
  Result<std::optional<Completion>> Complete(size_t f, bool with_plate) override;
  void ForgetPicture(size_t f) override;
  // The gaps of a frame's lenses, as the last call of Complete() with with_plate made them; null if
  // the frame has none.
  const PlateGaps* GapsOf(size_t f) const {
    return frames_[f].kept_gaps ? &*frames_[f].kept_gaps : nullptr;
  }
  // Develops the rays that the frame has so far.
  Result<RenderedFrame> Develop(size_t f);
  RenderedFrame Develop(size_t f, const std::optional<Completion>& completion, bool with_effective,
                        const std::function<bool()>& is_interrupted) const override;
  // Measures samples and noise if FilmSettings::stop_when or require has a rule for them, and adds
  // them to the report; leaves out the noise if moments(f) is null. kInterrupted:
  // WorkSettings::stop is set.
  Result<void> Measure(size_t f, FrameReport* report) override;
  // Returns the facts that are needed to develop the frame's plate. The caller adds the skipped LF
  // images and the program's version.
  PlateNotes NotesOf(size_t f) const override;

  void Release(size_t f) override;
  bool IsReleased(size_t f) const override { return frames_[f].is_released; }

  // Saves the plates, then the rebinned rays.
  bool CanSave() const override { return true; }
  Result<void> Save(RunState* state) override;
  void End(RunState* state) override;
  Result<void> WritePlateOf(size_t f, const std::filesystem::path& path, const RunState& state,
                            PlateNotes notes, std::span<const SkippedImage> skipped) const override;

  const FilmSetup& setup() const { return setup_; }
  const std::vector<SelectedImage>& images() const override { return images_; }
  CollectProgress progress() const override { return done_; }
  CollectProgress total() const override;
  std::span<const SkippedImage> skipped() const override { return collector_->skipped(); }
  void AddTo(RenderReport* totals) const override;
  const CollectTimes& times() const { return collector_->times(); }
  // The rebinned rays of the frames, or their kept pixels; null if the mode has none.
  const RebinnedRays* rebinned() const { return rebinned_.get(); }
  const FramePixels* pixels() const { return pixels_.get(); }
  // kInput: no LF image contributes to any frame, and no ray was collected before. This is so if no
  // recorded ray passes both a frame's lens and the region that the frame sees.
  Result<void> CheckAnyContributes() const;
  bool AllBroken() const override;

 private:
  struct Frame {
    FrameId id;
    std::vector<FrameLens> lenses;      // of its instants; empty until Begin()
    std::optional<FrameLens> all_lens;  // set if the plate is guarded
    SensorPlate plate{0, 0};
    std::vector<GapLens> gaps;  // parts of the lenses that kept pixels complete, with kHybrid
    // With kRebin, the rays that were collected from kept pixels, and their counts.
    SensorPlate kept_plate{0, 0};
    FrameRays kept_rays;
    std::optional<PlateGaps> kept_gaps;  // see GapsOf()
    NoiseMoments moments;                // moments of the plate; empty if noise is not measured
    // Places of the LF images that this run still collects. If there is an earlier run, the plate
    // already has the rays of the LF images at ranks before ranks.begin.
    RankRange ranks;
    FrameRays earlier_rays;  // rays in the plate when this run began
    // FilmSettings::stop_when is applied at ranks that are multiples of this number.
    uint32_t decision_ranks = 0;
    uint32_t next_decision = 0;  // next rank at which the stop rule is applied
    bool is_released = false;
    bool is_stopped = false;  // true: stopped by its rule, with the LF images before next_decision
    bool has_noise = false;   // true if the moments include all LF images in the plate
    bool is_early = false;  // true: to be finished with the rays of the earlier run, as EndsEarly()
    int correction = 0;     // CollectedFrame::correction
    uint32_t saved_ranks = 0;  // FrameProgress::ranks_done of the plate in the state on the disk
    std::unique_ptr<ReachableElements> reachable;
  };

  Result<void> FindLenses();
  void ChooseCorrections();
  TakingFrame Taking(const Frame& frame, const FrameLens& lens) const;
  std::vector<TakingFrame> TakingInstants(const Frame& frame) const;
  ImageWeights WeightsIn(const FrameLens& lens) const;
  FrameGuard GuardOf(const Frame& frame) const;
  SensorPlate EmptyPlateOf(const Frame& frame) const;
  // The index of the LF images that stop rules and reports count.
  const ImageIndex& counted_index() const {
    return setup_.is_guarded() ? setup_.index().recorded() : setup_.index();
  }
  // True if the plates of frames are collected from kept pixels.
  bool CollectsKept() const { return pixels_ != nullptr && !film_.Collects(); }
  CollectedFrame CollectedInto(SensorPlate* plate, const Frame& frame) const;
  uint32_t RebinnedRanksDone() const;
  Result<void> PreparePixels(const RunState* state);
  Result<void> FindGaps();
  std::vector<TakingFrame> TakingGaps(const Frame& frame) const;
  Result<void> CheckRoom() const;
  void AddKeptImages();
  Result<void> CollectKept(Frame* frame, uint32_t rank_end);
  Result<void> CheckKeptAdd() const;
  Result<PlateGaps> CollectGaps(const Frame& frame, uint32_t rank_end);
  Result<void> CollectFromKept(std::vector<CollectedFrame>* frame,
                               std::span<const TakingFrame> taking) const;
  Result<void> PrepareRebinning(const RunState* state);
  Result<void> CheckReach(const LensGaps& gaps, FrameId frame) const;
  Result<void> PreparePlates(const RunState* state);
  Result<FrameProgress> LoadPlate(Frame* frame, const RunState* state) const;
  bool LacksRays(size_t f, uint32_t ranks_done) const;
  void SelectForFrames();
  void AddRebinnedImages();
  CollectOptions OptionsOfCollector() const;
  std::vector<CollectedFrame> FramesOfCollector();
  void EndEarlyFrames();
  Result<void> SavePlates(RunState* state, std::span<const size_t> frames);
  Result<void> SaveRays(RunState* state);
  std::string RaysFrames() const;

  const ReachableElements& ReachableOf(size_t f);
  Result<void> PrepareStops(CollectOptions* collect);
  void ForgetRaysAhead();
  uint32_t RanksCovered(uint32_t ranks_done) const;
  double NoiseOf(size_t f);
  bool IsEnough(size_t f);
  uint32_t DecisionFrom(size_t f, uint32_t rank) const;
  void DecideStops();

  std::unique_ptr<FilmSetup> own_setup_;  // setup of a renderer made by Open(); otherwise null
  const FilmSetup& setup_;
  const FilmSettings& film_;  // options of the setup
  const SelectOptions select_;
  std::vector<Frame> frames_;
  std::vector<SelectedImage> images_;
  std::unique_ptr<FrameCollector> collector_;
  std::unique_ptr<RebinnedRays> rebinned_;  // the rebinned rays; null if the film has none
  std::unique_ptr<FramePixels> pixels_;     // the kept pixels; null if the film has none
  std::vector<uint32_t> saved_rays_ranks_;  // ranks_done of each section in the state on the disk
  CollectProgress done_;
};

}  // namespace lf
