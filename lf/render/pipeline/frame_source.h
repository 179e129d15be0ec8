// SPDX-License-Identifier: Apache-2.0
// Separates code that makes frames from code that saves them. A FrameSource collects the frames of
// one pass from LF images, batch by batch, and develops them; RenderPass (render_pass.h) owns the
// folder: files, records, checkpoints and signals. FilmRenderer is the source of lfrenderer. A
// FilmSource makes the sources of all passes of a film.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/collect/collect.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/state/plate_notes.h"
#include "lf/render/state/report.h"
#include "lf/render/state/run_inputs.h"
#include "lf/render/state/run_state.h"
#include "lf/selection/select.h"

namespace lf {

class FilmSetup;
struct RenderOptions;

// Frames are given by their index f, in the order of the frames of the pass.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // Selects the LF images that are still to be collected. Must be called once, before the functions
  // below.
  //   state  its finished frames are released, and the others resume from what Save() wrote there;
  //          null: all frames start empty. Used only during the call
  //   early  frames to be finished with the rays that the state has of them, ascending
  virtual Result<void> Begin(const RunState* state, std::span<const FrameId> early) = 0;
  // Collects the next batch of LF images. Returns false if no LF image was left. After
  // kInterrupted, the caller may call Step() again.
  virtual Result<bool> Step() = 0;
  // The LF images that all steps together read, by ascending ranks.
  virtual const std::vector<SelectedImage>& images() const = 0;
  // Progress so far, and the progress that the last step will reach.
  virtual CollectProgress progress() const = 0;
  virtual CollectProgress total() const = 0;
  // Broken LF images that the steps left out.
  virtual std::span<const SkippedImage> skipped() const = 0;
  // True if all LF images were broken (or there were none), and nothing was collected before.
  virtual bool AllBroken() const = 0;
  // kInput: AllBroken() is true, and there was at least one LF image. The message says what is
  // wrong with the first one.
  Result<void> CheckNotAllBroken() const;
  // Adds the times of the steps, and facts about what was collected, to the report.
  virtual void AddTo(RenderReport* totals) const = 0;

  virtual size_t frame_count() const = 0;
  virtual FrameId id(size_t f) const = 0;
  virtual FrameProgress Progress(size_t f) const = 0;
  // True if the frame is to be finished with what the state has of it, although it lacks LF images.
  virtual bool EndsEarly(size_t f) const = 0;
  // Returns the frames that need no further LF image, and that are not released yet.
  virtual std::vector<size_t> StoppedFrames() const = 0;
  // Frees the memory of a frame, which takes no more LF images.
  virtual void Release(size_t f) = 0;
  virtual bool IsReleased(size_t f) const = 0;
  bool AreAllReleased() const;

  // Returns the part of the picture that is interpolated from rays in memory; nullopt if there is
  // none. Must be called before Develop(), WritePlateOf() and Progress() of a frame that is
  // finished, because it may collect the frame's rays. Only one thread at a time may call it.
  // kInterrupted: WorkSettings::stop is set. kOutput: there is not enough memory.
  //   with_plate  true: WritePlateOf() follows, which needs all that this made for the picture.
  //               nullopt is then returned if the film is rendered in shards, because shards make
  //               no pictures
  virtual Result<std::optional<Completion>> Complete(size_t f, bool with_plate) = 0;
  // Frees what Complete() made for the picture of a frame; Complete() makes it again.
  virtual void ForgetPicture(size_t /*f*/) {}
  // Develops what was collected of the frame so far. FrameReport::samples and noise are not set,
  // because Measure() sets them. Several threads may call Develop(), Measure() and NotesOf() at the
  // same time, for different frames.
  //   completion  result of Complete() for this frame
  // with_effective and is_interrupted are explained at DevelopFrame().
  virtual RenderedFrame Develop(size_t f, const std::optional<Completion>& completion,
                                bool with_effective,
                                const std::function<bool()>& is_interrupted) const = 0;
  // Adds the measurements that the settings ask for to the report.
  virtual Result<void> Measure(size_t f, FrameReport* report) = 0;
  // Returns the facts about a frame that its files state. The caller adds the version.
  virtual PlateNotes NotesOf(size_t f) const = 0;

  // False if Save() does nothing: an interrupted pass then begins again with the frames that were
  // not finished.
  virtual bool CanSave() const = 0;
  // Saves what was collected since the last call of frames that are not released, for Begin() of a
  // later run.
  virtual Result<void> Save(RunState* state) = 0;
  // Ends a pass whose frames are all finished: removes the data that they shared from the state.
  virtual void End(RunState* state) = 0;
  // Writes the plate of a finished frame, for which Complete() was called with with_plate. Several
  // threads may call it at the same time, for different frames.
  //   notes    result of NotesOf(), with the version
  //   skipped  LF images that the render has left out so far
  // kUsage: the frames have no plates.
  virtual Result<void> WritePlateOf(size_t f, const std::filesystem::path& path,
                                    const RunState& state, PlateNotes notes,
                                    std::span<const SkippedImage> skipped) const = 0;
};

// How a film is divided into passes, each of which reads the LF images of its frames.
struct PassPlan {
  size_t frames_per_pass = 1;
  size_t frames_finished_at_once = 1;  // number of frames that are developed at the same time
  size_t readings = 1;                 // number of times that a pass reads its LF images
  std::string fitting;  // what fits in the memory, for messages: "3 plates of 20 MiB"
};

class FilmSource {
 public:
  virtual ~FilmSource() = default;

  // kUsage: the package or the options are not for frames of this source. Called before
  // CheckRenderOptions() checks what all sources have in common.
  virtual Result<void> Check(const Package& package, const RenderOptions& options) const = 0;
  // Returns the inputs of the rays that the settings do not state (InputsOfRays()).
  virtual RunInputs Inputs() const = 0;
  // Returns entries for the metadata of all frames.
  virtual ImageMetadata Metadata() const = 0;
  // Plans the passes of these frames of the setup; called once before Open(). kOutput: the memory
  // does not suffice. kInterrupted: WorkSettings::stop is set.
  virtual Result<PassPlan> Plan(FilmSetup* setup, std::span<const FrameId> frames) = 0;
  // Returns the source of a pass. The setup and this object must outlive it.
  //   frames  at most PassPlan::frames_per_pass, ascending
  virtual std::unique_ptr<FrameSource> Open(const FilmSetup& setup,
                                            std::span<const FrameId> frames) const = 0;
};

}  // namespace lf
