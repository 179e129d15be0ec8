// SPDX-License-Identifier: Apache-2.0
// One pass over the LF images: renders a group of frames, whose plates fit in the memory together,
// into a folder, and writes the state of unfinished frames there. Internal to this folder.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lf/render/pipeline/film_setup.h"
#include "lf/render/pipeline/frame_source.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/dump_clock.h"
#include "lf/render/state/run_state.h"

namespace lf {

// Returns the time of a monotonic clock, in seconds.
inline double NowSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The objects that all passes of a render share.
struct PassContext {
  const FilmSetup& setup;
  const FolderOptions& folder;
  ImageMetadata metadata;          // entries for the metadata of all frames
  size_t frames_finished_at_once;  // PassPlan::frames_finished_at_once
  RenderSignals* signals;          // requests to the render; may be null
  RunState& state;
  DumpClock& clock;
  // Totals of finished passes and earlier runs; its total_s is that of earlier runs alone.
  RenderReport& totals;
  double begin_s;       // NowSeconds() when this run began
  size_t& black_count;  // number of frames that this run finished without a ray
  std::function<void(const CollectProgress&, size_t finished_count)> progress;
};

class RenderPass {
 public:
  //   source  of the frames of the pass. Finished frames are not rendered, but are among them,
  //           because which rebinned rays are kept depends on all frames of the pass.
  //   early   frames that are to be finished with the rays of the state alone, ascending
  RenderPass(const PassContext& context, std::unique_ptr<FrameSource> source,
             std::span<const FrameId> early);

  // Loads the rays of an earlier run, and selects the LF images that are still to be collected.
  // kInput: the state is damaged. Other errors are those of FrameSource::Begin().
  Result<void> Prepare();
  const FrameSource& source() const { return *source_; }

  // Collects until all LF images are done or all frames are finished. kInterrupted: the state was
  // written.
  Result<void> Collect();
  // Writes the frames that are not finished yet. kInterrupted: the state was written.
  Result<void> Finish();

 private:
  // A frame whose file is written.
  struct Written {
    size_t f = 0;
    FrameReport report;
  };

  Result<void> FinishEarlyFrames();
  Result<void> FinishStoppedFrames();
  Result<void> FinishFrames(std::span<const size_t> frames);
  Result<void> FinishAtOnce(std::span<const size_t> frames);
  PlateNotes NotesOf(size_t f) const;
  Result<FrameReport> WriteFiles(size_t f, const std::optional<Completion>& completion);
  Result<FrameReport> WritePicture(size_t f, const std::optional<Completion>& completion,
                                   const std::filesystem::path& to,
                                   const std::function<bool()>& is_interrupted) const;
  bool WritesPlates() const {
    return context_.folder.keep_plates || context_.setup.film().shard.has_value();
  }
  void WarnIfBlack(const FrameReport& report);
  void BeginRecords();
  Result<void> EndRecords();
  RenderReport Totals() const;

  Result<void> Save(double picture_budget_s);
  Result<void> SaveAllRays();
  Result<void> SavePictures(double picture_budget_s);
  Result<void> SaveWhenDue();
  Error Interrupt();
  bool IsStopped() const { return context_.setup.work().IsStopped(); }

  const PassContext& context_;
  const std::vector<FrameId> early_;
  const std::unique_ptr<FrameSource> source_;
  std::vector<double> pictures_s_;  // NowSeconds() when the picture of each frame was last written
  size_t finished_count_ = 0;
  // Frames whose records are being written, and the thread that writes them. The thread is declared
  // last, so that it has ended before anything else is destroyed.
  std::vector<Written> recording_;
  std::future<Result<void>> records_;
};

}  // namespace lf
