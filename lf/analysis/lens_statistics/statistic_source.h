// SPDX-License-Identifier: Apache-2.0
// The frames of one pass, made by a statistic over the lens. Internal to this folder.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lf/analysis/lens_statistics/element_values.h"
#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/core/image.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/memory_plan.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/pipeline/frame_source.h"
#include "lf/selection/select.h"

namespace lf {

// How the memory is divided. A plate has the rays of one LF image in one frame.
struct StatisticPlan {
  MemoryPlan collect;          // frames_per_pass is the number of plates for each frame
  int rows = 1;                // number of rows of a part of a frame, whose values fit
  size_t frames_per_pass = 1;  // number of frames whose values fit together; 1 if there are parts
};

// Returns the ranks of the order that a frame takes, and the frame, for a selection.
TakingFrame TakingOf(const FilmSetup& setup, FrameId frame);

class StatisticSource final : public FrameSource {
 public:
  // The setup must outlive the source.
  StatisticSource(const FilmSetup& setup, const LensStatisticOptions& options,
                  const StatisticPlan& plan, std::span<const FrameId> frames);
  ~StatisticSource() override;

  // `early` must be empty.
  Result<void> Begin(const RunState* state, std::span<const FrameId> early) override;
  // Errors are those of FrameCollector::Step().
  Result<bool> Step() override;
  const std::vector<SelectedImage>& images() const override { return images_; }
  CollectProgress progress() const override { return done_; }
  CollectProgress total() const override;
  std::span<const SkippedImage> skipped() const override { return skipped_; }
  bool AllBroken() const override { return skipped_.size() == images_.size(); }
  void AddTo(RenderReport* totals) const override;

  size_t frame_count() const override { return frames_.size(); }
  FrameId id(size_t f) const override { return frames_[f].id; }
  FrameProgress Progress(size_t f) const override;
  bool EndsEarly(size_t /*f*/) const override { return false; }
  std::vector<size_t> StoppedFrames() const override { return {}; }
  void Release(size_t f) override;
  bool IsReleased(size_t f) const override { return frames_[f].is_released; }

  Result<std::optional<Completion>> Complete(size_t /*f*/, bool /*with_plate*/) override {
    return std::optional<Completion>();
  }
  RenderedFrame Develop(size_t f, const std::optional<Completion>& completion, bool with_effective,
                        const std::function<bool()>& is_interrupted) const override;
  Result<void> Measure(size_t /*f*/, FrameReport* /*report*/) override { return {}; }
  PlateNotes NotesOf(size_t f) const override;

  // The values of a pass take most of the memory, and as much of the disk: they are not saved.
  bool CanSave() const override { return false; }
  Result<void> Save(RunState* /*state*/) override { return {}; }
  void End(RunState* /*state*/) override {}
  Result<void> WritePlateOf(size_t f, const std::filesystem::path& path, const RunState& state,
                            PlateNotes notes, std::span<const SkippedImage> skipped) const override;

 private:
  struct Frame {
    FrameId id;
    std::vector<SelectedImage> images;  // LF images that the frame takes, by ascending ranks
    // Sums and counts of the ranks that the statistic takes.
    SensorPlate plate{0, 0};
    Image<uint32_t> counts;               // number of values of each element
    std::optional<ElementValues> values;  // of the elements of the part
    FrameRays rays;
    bool is_released = false;
    bool Takes(uint32_t rank) const;
  };
  // LF images of order_ that are collected, each into a plate of its own for each frame.
  struct Group;

  int width() const;
  int height() const;
  void BeginPart(int y_begin);
  void BeginGroup();
  void EndGroup();
  Result<void> EndPart();
  void LeaveOutBroken();

  const FilmSetup& setup_;
  const LensStatisticOptions& options_;
  const StatisticPlan plan_;
  const PlateKind kind_;
  std::vector<Frame> frames_;
  std::vector<SelectedImage> images_;  // of all frames
  std::vector<SelectedImage> order_;   // images_, without broken ones after the first part
  PixelRect part_;                     // the rows that are made now
  size_t next_ = 0;                    // index of the next LF image of order_ in this part
  std::unique_ptr<Group> group_;       // null between two groups
  std::vector<SkippedImage> skipped_;
  CollectProgress done_;  // LF images are counted once for each part
  CollectTimes times_;
  bool is_done_ = false;
};

}  // namespace lf
