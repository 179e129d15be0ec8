// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/statistic_source.h"

#include <algorithm>
#include <utility>

#include "lf/render/collect/collected_frame.h"
#include "lf/render/collect/develop_options.h"
#include "lf/render/pipeline/develop_frame.h"

namespace lf {

struct StatisticSource::Group {
  size_t end = 0;  // index in order_ of the first LF image that is not in the group
  std::vector<SelectedImage> order;
  std::vector<SensorPlate> plates;
  std::vector<size_t> frames;  // the frame of each plate
  size_t told = 0;             // number of LF images of the group that done_ counts so far
  std::unique_ptr<FrameCollector> collector;
};

TakingFrame TakingOf(const FilmSetup& setup, FrameId frame) {
  TakingFrame taking = {setup.path().Camera(frame)};
  if (setup.film().max_image_count)
    taking.ranks = RanksOfFirst(*setup.film().max_image_count, setup.index().recorded(), taking,
                                setup.Select());
  return taking;
}

StatisticSource::StatisticSource(const FilmSetup& setup, const LensStatisticOptions& options,
                                 const StatisticPlan& plan, std::span<const FrameId> frames)
    : setup_(setup),
      options_(options),
      plan_(plan),
      kind_(PlateKindOf(setup.light_field().encoding, false)),
      frames_(frames.size()) {
  for (size_t f = 0; f < frames.size(); ++f) frames_[f].id = frames[f];
}

StatisticSource::~StatisticSource() = default;

int StatisticSource::width() const {
  return setup_.path().Camera(frames_.front().id).pinhole.intrinsics.width_px;
}
int StatisticSource::height() const {
  return setup_.path().Camera(frames_.front().id).pinhole.intrinsics.height_px;
}

bool StatisticSource::Frame::Takes(uint32_t rank) const {
  const auto found = std::lower_bound(
      images.begin(), images.end(), rank,
      [](const SelectedImage& image, uint32_t wanted) { return image.rank < wanted; });
  return found != images.end() && found->rank == rank;
}

Result<void> StatisticSource::Begin(const RunState* state, std::span<const FrameId> /*early*/) {
  const ImageIndex& index = setup_.index().recorded();
  const SelectOptions select = setup_.Select();
  std::vector<TakingFrame> all;
  for (Frame& frame : frames_) {
    frame.is_released = state != nullptr && state->finished().contains(frame.id);
    if (frame.is_released) continue;
    all.push_back(TakingOf(setup_, frame.id));
    frame.images = SelectImages(index, std::span(&all.back(), 1), select, setup_.pool());
    frame.plate = SensorPlate(width(), height(), kind_);
    frame.counts = Image<uint32_t>(width(), height());
  }
  images_ = order_ = SelectImages(index, all, select, setup_.pool());
  if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  is_done_ = images_.empty();
  if (!is_done_) BeginPart(0);
  return {};
}

void StatisticSource::BeginPart(int y_begin) {
  part_ = {0, y_begin, width(), std::min(height(), y_begin + plan_.rows)};
  next_ = 0;
  for (Frame& frame : frames_)
    if (!frame.is_released)
      frame.values.emplace(width(), part_, static_cast<int>(kind_), frame.images.size());
}

Result<bool> StatisticSource::Step() {
  if (is_done_) return false;
  if (!group_) BeginGroup();
  LF_ASSIGN_OR_RETURN(const bool stepped, group_->collector->Step());
  for (; group_->told < group_->collector->images_done(); ++group_->told) {
    ++done_.image_count;
    done_.tested_count += group_->order[group_->told].ray_count;
  }
  if (stepped) return true;
  EndGroup();
  if (next_ == order_.size()) LF_RETURN_IF_ERROR(EndPart());
  return true;
}

void StatisticSource::BeginGroup() {
  group_ = std::make_unique<Group>();
  Group& group = *group_;
  const size_t most = plan_.collect.frames_per_pass * frames_.size();
  std::vector<RankRange> ranks;
  for (group.end = next_; group.end < order_.size(); ++group.end) {
    const uint32_t rank = order_[group.end].rank;
    std::vector<size_t> takers;
    for (size_t f = 0; f < frames_.size(); ++f)
      if (frames_[f].Takes(rank)) takers.push_back(f);
    if (group.end > next_ && group.frames.size() + takers.size() > most) break;
    group.order.push_back(order_[group.end]);
    group.frames.insert(group.frames.end(), takers.begin(), takers.end());
    ranks.insert(ranks.end(), takers.size(), {rank, rank + 1});
  }
  for (size_t i = 0; i < group.frames.size(); ++i) group.plates.emplace_back(0, 0);
  setup_.pool().ForEach(group.plates.size(),
                        [&](size_t i) { group.plates[i] = SensorPlate(width(), height(), kind_); });
  std::vector<CollectedFrame> collected;
  for (size_t i = 0; i < group.frames.size(); ++i)
    collected.push_back(
        {setup_.path().Camera(frames_[group.frames[i]].id), &group.plates[i], ranks[i]});
  CollectOptions options;
  options.reading = setup_.film().reading;
  options.batch_image_count = static_cast<int>(plan_.collect.batch_image_count);
  options.plan_bytes = plan_.collect.plan_bytes;
  options.decision_ranks = 0;
  options.rank_end = setup_.index().rank_end();
  // An LF image that was whole for the first part must be whole for the others.
  options.strict = setup_.work().strict || part_.y_begin > 0;
  options.interrupted = setup_.work().interrupted;
  group.collector =
      std::make_unique<FrameCollector>(setup_.light_field(), setup_.store(), std::move(collected),
                                       group.order, options, setup_.pool());
}

void StatisticSource::EndGroup() {
  const std::unique_ptr<Group> group = std::move(group_);
  const FrameCollector& collector = *group->collector;
  if (part_.y_begin == 0) {
    for (size_t i = 0; i < group->frames.size(); ++i)
      frames_[group->frames[i]].rays += collector.frames()[i].progress.rays;
    skipped_.insert(skipped_.end(), collector.skipped().begin(), collector.skipped().end());
  }
  times_.load_cpu_s += collector.times().load_cpu_s;
  times_.load_wall_s += collector.times().load_wall_s;
  times_.collect_cpu_s += collector.times().collect_cpu_s;
  setup_.pool().ForEach(static_cast<size_t>(part_.height()), [&](size_t row) {
    for (size_t i = 0; i < group->plates.size(); ++i)
      frames_[group->frames[i]].values->AddRow(group->plates[i],
                                               part_.y_begin + static_cast<int>(row));
  });
  next_ = group->end;
}

// Takes the statistic of all elements of the part. kInterrupted: the pass must begin again.
Result<void> StatisticSource::EndPart() {
  for (Frame& frame : frames_) {
    if (!frame.values) continue;
    setup_.pool().ForEach(static_cast<size_t>(part_.height()), [&](size_t row) {
      if (setup_.work().IsStopped()) return;
      const int y = part_.y_begin + static_cast<int>(row);
      for (int x = 0; x < width(); ++x) frame.counts.at(x, y) = frame.values->Count(x, y);
      frame.values->TakeRow(y, options_, &frame.plate);
    });
    frame.values.reset();
  }
  if (setup_.work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  if (part_.y_begin == 0) LeaveOutBroken();
  is_done_ = part_.y_end == height() || order_.empty();
  if (!is_done_) BeginPart(part_.y_end);
  return {};
}

void StatisticSource::LeaveOutBroken() {
  const auto is_broken = [this](const SelectedImage& image) {
    return std::any_of(skipped_.begin(), skipped_.end(),
                       [&](const SkippedImage& skipped) { return skipped.rank == image.rank; });
  };
  std::erase_if(order_, is_broken);
}

CollectProgress StatisticSource::total() const {
  const auto parts = static_cast<size_t>((height() + plan_.rows - 1) / plan_.rows);
  CollectProgress total = {images_.size() + (parts - 1) * order_.size(), 0};
  for (const SelectedImage& image : images_) total.tested_count += image.ray_count;
  for (const SelectedImage& image : order_) total.tested_count += (parts - 1) * image.ray_count;
  return total;
}

void StatisticSource::AddTo(RenderReport* totals) const {
  totals->load_cpu_s += times_.load_cpu_s;
  totals->load_wall_s += times_.load_wall_s;
  totals->collect_cpu_s += times_.collect_cpu_s;
}

FrameProgress StatisticSource::Progress(size_t f) const {
  return {is_done_ ? setup_.index().rank_end() : 0, frames_[f].rays};
}

void StatisticSource::Release(size_t f) {
  Frame& frame = frames_[f];
  frame.is_released = true;
  frame.values.reset();
  frame.plate = SensorPlate(0, 0);
  frame.counts = {};
}

RenderedFrame StatisticSource::Develop(size_t f, const std::optional<Completion>& /*completion*/,
                                       bool /*with_effective*/,
                                       const std::function<bool()>& is_interrupted) const {
  const Frame& frame = frames_[f];
  RenderedFrame rendered =
      DevelopFrame(NotesOf(f), frame.plate, nullptr, false, setup_.pool(), is_interrupted);
  if (is_interrupted && is_interrupted()) return rendered;
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x)
      for (int c = 0; c < SensorPlate::kChannels; ++c)
        rendered.picture.ray_count.at(x, y, c) = frame.counts.at(x, y);
  FrameReport report = MakeFrameReport(frame.id, frame.rays, rendered.picture);
  report.camera = std::move(rendered.report.camera);
  report.develop_s = rendered.report.develop_s;
  rendered.report = std::move(report);
  return rendered;
}

PlateNotes StatisticSource::NotesOf(size_t f) const {
  const Frame& frame = frames_[f];
  PlateNotes notes;
  notes.frame = frame.id;
  notes.camera = setup_.path().Camera(frame.id);
  notes.rays = frame.rays;
  notes.fps = setup_.path().fps;
  notes.first_frame = setup_.path().first_frame;
  notes.develop = DevelopOptionsOf(setup_.light_field().encoding);
  notes.develop.adds_opacity = setup_.film().adds_opacity;
  for (const SkippedImage& image : skipped_)
    if (frame.Takes(image.rank)) notes.skipped.push_back(image.name);
  notes.skipped_count = notes.skipped.size();
  return notes;
}

Result<void> StatisticSource::WritePlateOf(size_t /*f*/, const std::filesystem::path& path,
                                           const RunState& /*state*/, PlateNotes /*notes*/,
                                           std::span<const SkippedImage> /*skipped*/) const {
  return UsageError(path.string() + ": frames of a statistic have no plates");
}

}  // namespace lf
