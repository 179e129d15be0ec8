// Renders frames of a film in memory: without folders, files or signals.
//
//   LF_ASSIGN_OR_RETURN(auto renderer, FilmRenderer::Open(package, film, work, {FrameId{7}},
//   pool)); for (bool is_going_on = true; is_going_on;) {
//     LF_ASSIGN_OR_RETURN(is_going_on, renderer->Step());  // one batch of LF images
//     Show(renderer->Develop(0).picture);                  // the frame with the rays so far
//   }
//
// Between two steps, every frame has exactly the rays of the LF images at its first places of the
// order. Frames have the same bits however the work is cut.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/rebinning/ray_map.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/collect/sample_rule.h"
#include "lf/render/hybrid/lens_gaps.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/report.h"

namespace lf {

// The rays that an earlier run has of the frames, from which a FilmRenderer goes on.
class EarlierRun {
 public:
  virtual ~EarlierRun() = default;
  // Returns true if the frame is finished, so that nothing is collected for it.
  virtual bool IsFinished(FrameId frame) const = 0;
  // Returns true if the frame is to end with the rays that the run has of it.
  virtual bool EndsEarly(FrameId frame) const = 0;
  // Adds the rays that the run has of the frame to the plate, and returns its progress.
  //   plate    empty, of the frame's size
  //   moments  receives the moments of these rays if the run has them; null if nobody needs them
  virtual Result<FrameProgress> LoadPlate(FrameId frame, SensorPlate* plate,
                                          std::optional<NoiseMoments>* moments) const = 0;
  // Returns the rebinned rays of a section (RebinnedRays::map()); none if the run has none.
  struct Rays {
    RayMap map;
    uint32_t places_done = 0;
  };
  virtual Result<std::optional<Rays>> LoadRays(size_t section, size_t max_cells) const = 0;
};

class FilmRenderer {
 public:
  // Makes a renderer of some frames of the package, ready for the first step. The pool must outlive
  // it.
  //   frames  ascending; empty: all of the package
  // kUsage, kInput: those of FilmSetup::Make(), and of PlanSlabs(). kOutput: the memory does not
  // suffice for all of the frames at the same time; the message names the number that fits.
  static Result<std::unique_ptr<FilmRenderer>> Open(Package package, const FilmOptions& film,
                                                    const WorkOptions& work,
                                                    std::vector<FrameId> frames, ThreadPool& pool);

  // The setup must have slabs, and outlive the renderer.
  //   frames  some of the setup's, ascending; at most plan().frames_per_pass. The kept rebinned
  //           rays depend on all of them, finished ones included.
  FilmRenderer(const FilmSetup& setup, std::span<const FrameId> frames);

  // Selects the LF images that are still to be collected. Must be called once, before all below.
  //   earlier  null: nothing is collected yet; only used during the call
  // kInterrupted; the errors of `earlier`; kUsage if a package lacks LF cameras that rebinned rays
  // ask for.
  Result<void> Begin(const EarlierRun* earlier = nullptr);

  // Collects the next batch of LF images, and stops the frames whose stop rule is met. Returns
  // false if nothing was left to do. Errors: those of FrameCollector::Step(). After kInterrupted,
  // steps may go on.
  Result<bool> Step();

  size_t frame_count() const { return frames_.size(); }
  FrameId id(size_t f) const { return frames_[f].id; }
  // Returns the progress with all rays in the plate, those of an earlier run included.
  FrameProgress Progress(size_t f) const;
  const SensorPlate& plate(size_t f) const { return plates_[f]; }  // if FilmOptions::HasPlates()
  // Returns the moments of the plate; null unless they are of all its LF images.
  const NoiseMoments* moments(size_t f) const {
    return frames_[f].has_noise ? &moments_[f] : nullptr;
  }
  const FrameLens& lens(size_t f) const { return lenses_[f]; }

  // True if the frame ends with the rays of the earlier run.
  bool EndsEarly(size_t f) const { return frames_[f].is_early; }
  // Returns the frames that the stop rule has stopped, and that are not released.
  std::vector<size_t> StoppedFrames() const;
  // Returns the place of the order before which the frame ends: that of its stop rule, or that of
  // the LF images that it takes. It does not depend on how the work is cut.
  uint32_t PlaceOfEnd(size_t f) const;

  // Interpolates frames from rebinned rays, one after the other; empty without these.
  std::vector<Completion> Complete(std::span<const size_t> frames);
  // Develops the rays that the frame has so far. The report lacks measurements. The second form may
  // be called by several threads at the same time, for different frames.
  //   completion  of the frame, from Complete(); null without rebinned rays
  // with_effective and is_interrupted are those of DevelopFrame().
  RenderedFrame Develop(size_t f);
  RenderedFrame Develop(size_t f, const Completion* completion, bool with_effective,
                        const std::function<bool()>& is_interrupted) const;
  // Adds the measurements that the options ask for to the report. Several threads may call it at
  // the same time, for different frames. kInterrupted.
  Result<void> Measure(size_t f, FrameReport* report);
  // Returns the facts by which anybody can develop the frame's plate, without those about skipped
  // LF images and without the program's version.
  PlateNotes NotesOf(size_t f) const;

  // Frees the plate of a frame, which takes no more LF images.
  void Release(size_t f);
  bool IsReleased(size_t f) const { return frames_[f].is_released; }
  bool AreAllReleased() const;

  const FilmSetup& setup() const { return setup_; }
  const std::vector<SelectedImage>& images() const { return images_; }  // of all steps
  CollectProgress progress() const { return done_; }                    // by these images
  std::span<const SkippedImage> skipped() const { return collector_->skipped(); }
  const CollectTimes& times() const { return collector_->times(); }
  const RebinnedRays* rebinned() const { return rebinned_.get(); }  // null without
  // kInput: there is no LF image to collect, nor was one collected before: no recorded ray passes
  // both a frame's lens and what the frame sees.
  Result<void> CheckAnyContributes() const;
  // True if all LF images were broken (or there were none), and nothing was collected before.
  bool AllBroken() const;
  // kInput: AllBroken(), and there were LF images. The message has the first one's fault.
  Result<void> CheckNotAllBroken() const;

 private:
  struct Frame {
    FrameId id;
    PlaceRange places;             // of the LF images that it takes, in earlier runs and this one
    FrameRays earlier_rays;        // in its plate when this run began
    uint32_t decision_places = 0;  // stop_at_samples is decided at multiples of this
    uint32_t next_decision = 0;    // place
    bool is_released = false;
    bool is_stopped = false;  // by the stop rule, with the LF images before next_decision
    bool has_noise = false;   // true if the moments are of all LF images in its plate
    bool is_early = false;    // to be finished with the rays of the earlier run
    std::unique_ptr<ReachableElements> reachable;
  };

  Result<void> FindLenses();
  SelectOptions SelectCollected() const;
  Result<void> PrepareRebinning(std::span<const PlaceRange> places, const EarlierRun* earlier);
  Result<void> CheckReach(const LensGaps& gaps, FrameId frame) const;
  Result<void> PreparePlates(const EarlierRun* earlier, std::vector<PlaceRange>* places);
  Result<FrameProgress> LoadPlate(size_t f, const EarlierRun* earlier);
  void SelectForFrames(std::span<const PlaceRange> places);
  void AddRebinnedImages(std::span<const PlaceRange> places);
  CollectOptions OptionsOfCollector();
  void EndEarlyFrames();

  const ReachableElements& ReachableOf(size_t f);
  Result<void> PrepareStops(std::span<const PlaceRange> places, CollectOptions* collect);
  void ForgetRaysAhead(std::span<const PlaceRange> places);
  uint32_t PlacesCovered(uint32_t places_done) const;
  double NoiseOf(size_t f);
  bool IsEnough(size_t f);
  uint32_t DecisionFrom(size_t f, uint32_t place) const;
  void DecideStops();

  std::unique_ptr<FilmSetup> own_setup_;  // if made by Open()
  const FilmSetup& setup_;
  const FilmOptions& film_;  // of the setup
  const SelectOptions select_;
  std::vector<Frame> frames_;
  // One for each frame, in arrays of their own, because selection and collection take them so.
  std::vector<FrameLens> lenses_;
  std::vector<RenderCamera> cameras_;  // with these lenses
  std::vector<SensorPlate> plates_;
  std::vector<NoiseMoments> moments_;  // of the plates, if noise is measured; otherwise empty
  std::vector<SelectedImage> images_;
  std::unique_ptr<FrameCollector> collector_;
  std::unique_ptr<RebinnedRays> rebinned_;  // null without rebinned rays
  CollectProgress done_;
};

}  // namespace lf
