// One pass over the LF images: the frames whose plates fit in the memory together. Internal to
// pipeline.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/collector/collect.h"
#include "lf/collector/frame_lens.h"
#include "lf/collector/memory_plan.h"
#include "lf/collector/noise_moments.h"
#include "lf/collector/sample_rule.h"
#include "lf/pipeline/frame_output.h"
#include "lf/pipeline/render.h"
#include "lf/record/dump_clock.h"
#include "lf/record/run_state.h"

namespace lf {

// Returns the time of a monotonic clock.
inline double NowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The objects that all passes of a render share.
struct RenderJob {
  const Package& package;
  const ImageIndex& index;  // of the package
  const CameraPath& path;
  const RenderOptions& options;
  ThreadPool& pool;
  const LfImageStore& store;
  const MemoryPlan& plan;
  RunState& state;
  DumpClock& clock;
  RenderReport& totals;    // of finished passes and earlier runs; total_s is of earlier runs only
  size_t max_cells;        // of rebinned rays
  const FilmSlabs* slabs;  // of rebinned rays; null without them
  double begin_s;          // of this run
  size_t& black_count;     // frames that no LF image contributes to
  std::function<void(const CollectProgress&, size_t finished_count)> progress;

  bool Collects() const { return lf::Collects(options.mode); }
  // Returns true if frames have plates, for their pictures or to measure noise.
  bool HasPlates() const { return Collects() || options.MeasuresNoise(); }
  bool Rebins() const { return lf::Rebins(options.mode); }
  bool IsStopped() const { return options.signals != nullptr && options.signals->stop; }
  SelectOptions Select() const;
};

class RenderPass {
 public:
  //   frames  frames of the pass, ascending. Finished ones are not rendered; they are given because
  //           the kept rebinned rays depend on all frames of the pass.
  //   early   the frames, ascending, to finish with the rays of the state alone
  RenderPass(const RenderJob& job, std::span<const FrameId> frames, std::span<const FrameId> early);

  // Loads the plates of an earlier run, and selects the LF images that are still to be collected.
  // kInput: the state is damaged.
  Result<void> Prepare();
  const std::vector<SelectedImage>& images() const { return images_; }
  std::span<const SkippedImage> skipped() const { return collector_->skipped(); }
  // True if all LF images were broken (or there were none), and nothing was collected before.
  bool AllBroken() const;

  // Collects until all LF images are done. kInterrupted: the state is written.
  Result<void> Collect();
  // Writes the frames that are not finished yet. kInterrupted: the state is written.
  Result<void> Finish();

 private:
  struct Frame {
    FrameId id;
    PlaceRange places;             // of the LF images that it takes, in earlier runs and this one
    FrameRays earlier_rays;        // in its plate when the pass began
    uint32_t saved_places = 0;     // places done in the state on the disk
    uint32_t decision_places = 0;  // stop_at_samples is decided at multiples of this
    uint32_t next_decision = 0;    // place
    bool is_finished = false;
    bool is_stopped = false;  // by the stop rule, with the LF images before next_decision
    bool has_noise = false;   // true if the moments are of all LF images in its plate
    bool is_early = false;    // to be finished with the rays of the state
    double picture_s = 0;     // time when its picture was last written
    std::unique_ptr<ReachableElements> reachable;
  };

  void FindLenses();
  SelectOptions SelectCollected() const;
  Result<void> PreparePlates(std::vector<PlaceRange>* places);
  Result<void> CheckReach(const LensGaps& gaps, FrameId frame) const;
  Result<FrameProgress> LoadPlate(size_t f);
  Result<void> PrepareRebinning(std::span<const PlaceRange> places);
  void SelectForPass(std::span<const PlaceRange> places);
  void AddRebinnedImages(std::span<const PlaceRange> places);
  // Interpolates frames, one after the other; empty without rebinned rays.
  std::vector<Completion> Complete(std::span<const size_t> frames);
  FrameProgress ProgressOf(size_t f) const;
  const ReachableElements& ReachableOf(size_t f);
  bool HasStopRule() const { return job_.options.stop_at_samples || job_.options.stop_at_noise; }
  Result<void> PrepareStops(std::span<const PlaceRange> places, CollectOptions* collect);
  void ForgetRaysAhead(std::span<const PlaceRange> places);
  uint32_t PlacesCovered(uint32_t places_done) const;
  double NoiseOf(size_t f);
  bool IsEnough(size_t f);
  uint32_t DecisionFrom(size_t f, uint32_t place) const;
  Result<void> DecideStops();
  bool AreAllFinished() const;
  Result<void> Measure(size_t f, FrameReport* report);
  Result<void> FinishFrames(std::span<const size_t> frames);
  Result<void> FinishEarlyFrames();
  FrameSheet SheetOf(size_t f) const;
  Result<FrameReport> WriteFiles(size_t f, const Completion* completion);
  Result<FrameReport> WritePicture(size_t f, const Completion* completion,
                                   const std::filesystem::path& to,
                                   const std::function<bool()>& is_interrupted);
  Result<void> Conclude(size_t f, const FrameReport& report);
  Result<void> Save(double picture_budget_s);
  Result<void> SaveRays();
  Result<void> SavePictures(double picture_budget_s);
  Result<void> SaveWhenDue();
  Error Interrupt();
  RenderReport Totals() const;

  const RenderJob& job_;
  std::vector<Frame> frames_;
  std::vector<FrameLens> lenses_;      // one for each frame, like cameras and plates
  std::vector<RenderCamera> cameras_;  // with these lenses
  std::vector<SensorPlate> plates_;
  std::vector<NoiseMoments> moments_;  // of the plates, if noise is measured; otherwise empty
  std::vector<SelectedImage> images_;
  std::unique_ptr<FrameCollector> collector_;
  std::unique_ptr<RebinnedRays> rebinned_;   // null without rebinned rays
  std::vector<uint32_t> saved_rays_places_;  // places done of its sections in the state on the disk
  std::string rays_frames_;                  // frames that the rays are made for, in their files
  CollectProgress done_;
  size_t finished_count_ = 0;
};

}  // namespace lf
