// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/lens_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "lf/analysis/lens_statistics/lens_ranks.h"
#include "lf/core/byte_text.h"
#include "lf/core/image.h"
#include "lf/core/large_vector.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/collected_frame.h"
#include "lf/render/collect/develop_options.h"
#include "lf/render/collect/memory_plan.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

constexpr size_t kMostPlates = 16;  // plates, each of one LF image, that are in memory
constexpr size_t kMiB = size_t{1} << 20;

Result<void> CheckOptions(const LensStatisticOptions& options) {
  if (options.statistic == LensStatistic::kTrimmed && !(options.trim >= 0 && options.trim < 0.5))
    return UsageError(fmt::format(
        "the share {:g} is to be cut at each end: expected a number from 0 to below 0.5",
        options.trim));
  if (options.filter == PixelFilter::kMosaic)
    return UsageError(
        "the filter mosaic cannot be used for statistics over the lens, because its rays count "
        "differently in each colour: use auto or another filter");
  return {};
}

// The values of the elements of some rows of the plate.
class ElementValues {
 public:
  //   most  largest number of values of an element
  ElementValues(int width, const PixelRect& part, int channels, size_t most)
      : width_(width),
        part_(part),
        channels_(static_cast<size_t>(channels)),
        most_(most),
        counts_(static_cast<size_t>(part.pixel_count())),
        values_(counts_.size() * channels_ * most) {}

  static size_t BytesOfRow(int width, int channels, size_t most) {
    return static_cast<size_t>(width) *
           (sizeof(uint32_t) + static_cast<size_t>(channels) * most * sizeof(uint16_t));
  }

  // Adds the rays of one LF image, row by row of the part.
  void AddRow(const SensorPlate& plate, int y) {
    for (int x = 0; x < width_; ++x) {
      const ElementSum red = plate.At(x, y, 0);
      if (red.count == 0) continue;
      uint32_t& count = counts_[IndexOf(x, y)];
      for (size_t c = 0; c < channels_; ++c) {
        const ElementSum ray = plate.At(x, y, static_cast<int>(c));
        Of(x, y, c)[count] = static_cast<uint16_t>(ray.sum / std::max<uint64_t>(1, ray.count));
      }
      ++count;
    }
  }

  uint32_t Count(int x, int y) const { return counts_[IndexOf(x, y)]; }
  // Returns the values of a channel of an element, in the order in which LF images were added.
  std::span<uint16_t> Values(int x, int y, size_t channel) {
    return {Of(x, y, channel), Count(x, y)};
  }
  size_t channels() const { return channels_; }

 private:
  size_t IndexOf(int x, int y) const {
    return static_cast<size_t>(y - part_.y_begin) * static_cast<size_t>(width_) +
           static_cast<size_t>(x);
  }
  uint16_t* Of(int x, int y, size_t channel) {
    return values_.data() + (IndexOf(x, y) * channels_ + channel) * most_;
  }

  int width_;
  PixelRect part_;
  size_t channels_, most_;
  LargeVector<uint32_t> counts_;
  LargeVector<uint16_t> values_;  // [element][channel][most_]
};

// The steps of MakeStatisticFrame().
class StatisticMaker {
 public:
  StatisticMaker(const LightField& light_field, const LfImageStore& store,
                 const RenderCamera& camera, const RayReading& reading,
                 const LensStatisticOptions& options, ThreadPool& pool,
                 const std::function<void(size_t, size_t)>& progress)
      : light_field_(light_field),
        store_(store),
        camera_(camera),
        reading_(reading),
        options_(options),
        pool_(pool),
        progress_(progress),
        width_(camera.pinhole.intrinsics.width_px),
        height_(camera.pinhole.intrinsics.height_px),
        kind_(PlateKindOf(light_field.encoding, false)),
        plate_(width_, height_, kind_),
        counts_(width_, height_) {}

  Result<StatisticFrame> Make(FrameId id) {
    Select();
    if (IsStopped()) return Interrupted();
    StatisticFrame frame;
    frame.image_count = order_.size();
    if (order_.empty() && !options_.may_be_black) return NoCamera();
    if (!order_.empty()) {
      LF_ASSIGN_OR_RETURN(const int rows, PlanRows());
      frame.part_count = static_cast<size_t>((height_ + rows - 1) / rows);
      total_ = frame.part_count * order_.size();
      for (int y = 0; y < height_; y += rows)
        LF_RETURN_IF_ERROR(MakePart({0, y, width_, std::min(height_, y + rows)}));
    }
    if (rays_.image_count == 0 && skipped_.empty() && !options_.may_be_black) return NoCamera();
    frame.notes.frame = id;
    frame.notes.camera = camera_;
    frame.notes.rays = rays_;
    frame.notes.skipped_count = skipped_.size();
    for (const SkippedImage& image : skipped_) frame.notes.skipped.push_back(image.name);
    frame.notes.develop = DevelopOptionsOf(light_field_.encoding);
    frame.notes.develop.adds_opacity = options_.adds_opacity;
    frame.keeps_opacity = plate_.has_opacity();
    frame.picture = DevelopFrame(frame.notes, plate_, nullptr, false, pool_, [this] {
                      return IsStopped();
                    }).picture;
    if (IsStopped()) return Interrupted();
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        for (int c = 0; c < SensorPlate::kChannels; ++c)
          frame.picture.ray_count.at(x, y, c) = counts_.at(x, y);
    frame.report = MakeFrameReport(id, rays_, frame.picture);
    frame.report.camera = InputsOfCamera(id, camera_);
    frame.skipped = std::move(skipped_);
    return frame;
  }

 private:
  bool IsStopped() const { return options_.stop != nullptr && *options_.stop; }
  static Error Interrupted() { return {ErrorKind::kInterrupted, "interrupted"}; }
  static Error NoCamera() {
    return InputError(
        "no LF camera has a ray through the lens of the frame: open the aperture "
        "(lens.aperture_diameter in the path), or move the camera to the LF cameras");
  }

  void Select() {
    const ImageIndex index(light_field_);
    SelectOptions select;
    select.reach = ReachOf(reading_);
    select.max_angle_rad = options_.max_angle_rad;
    select.interrupted = options_.stop;
    order_ = SelectImages(index.recorded(), std::span(&camera_, 1), select, pool_);
  }

  // Returns the number of rows of a part whose values fit into the memory. Sets the plan.
  Result<int> PlanRows() {
    const size_t plates = std::min(kMostPlates, order_.size());
    const size_t result_bytes =
        static_cast<size_t>(width_) * height_ * (static_cast<size_t>(kind_) * 8 + 4);
    const size_t row_bytes =
        ElementValues::BytesOfRow(width_, static_cast<int>(kind_), order_.size());
    const auto plan_for = [&](size_t memory_bytes, size_t count) {
      return PlanMemory(memory_bytes, light_field_, reading_, width_, height_, count,
                        pool_.thread_count(), 0, false, 1, camera_.surface.get());
    };
    // A quarter of the memory is for LF images and their plates, more only if they need it.
    Result<MemoryPlan> plan = plan_for(options_.memory_bytes / 4, plates);
    if (!plan) plan = plan_for(options_.memory_bytes, 1);
    if (!plan) return plan.error();
    plan_ = *plan;
    const size_t others = plan_.total_bytes + result_bytes;
    if (options_.memory_bytes < others + row_bytes)
      return OutputError(fmt::format(
          "{{memory {}}} is too small: the values of a row of {} elements in {} LF images, the "
          "sums of a frame and two LF images need at least {} MiB",
          ByteText(options_.memory_bytes), width_, order_.size(), (others + row_bytes) / kMiB + 1));
    const size_t rows = (options_.memory_bytes - others) / row_bytes;
    return static_cast<int>(std::min(rows, static_cast<size_t>(height_)));
  }

  Result<void> MakePart(const PixelRect& part) {
    ElementValues values(width_, part, static_cast<int>(kind_), order_.size());
    const bool is_first = part.y_begin == 0;
    for (size_t begin = 0; begin < order_.size(); begin += plan_.frames_per_pass)
      LF_RETURN_IF_ERROR(Collect(begin, std::min(order_.size(), begin + plan_.frames_per_pass),
                                 is_first, part, &values));
    if (is_first) LeaveOutBroken();
    pool_.ForEach(static_cast<size_t>(part.height()), [&](size_t row) {
      if (!IsStopped()) TakeRow(part.y_begin + static_cast<int>(row), &values);
    });
    if (IsStopped()) return Interrupted();
    return {};
  }

  // Collects LF images of order_, each into a plate of its own, and adds the rays of the part.
  //   is_first  true: counts the LF images with rays, and broken ones may be left out
  Result<void> Collect(size_t begin, size_t end, bool is_first, const PixelRect& part,
                       ElementValues* values) {
    std::vector<SensorPlate> plates;
    std::vector<CollectedFrame> frames;
    std::vector<SelectedImage> order(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                                     order_.begin() + static_cast<std::ptrdiff_t>(end));
    plates.reserve(order.size());
    for (uint32_t i = 0; i < order.size(); ++i) {
      order[i].place = i;
      plates.emplace_back(width_, height_, kind_);
      frames.push_back({camera_, &plates.back(), {i, i + 1}});
    }
    CollectOptions options;
    options.reading = reading_;
    options.batch_image_count = static_cast<int>(plan_.batch_image_count);
    options.plan_bytes = plan_.plan_bytes;
    options.decision_places = 0;
    options.place_end = static_cast<uint32_t>(order.size());
    // An LF image that was whole for the first part must be whole for the others.
    options.strict = options_.strict || !is_first;
    options.interrupted = options_.stop;
    FrameCollector collector(light_field_, store_, std::move(frames), order, options, pool_);
    while (true) {
      LF_ASSIGN_OR_RETURN(const bool stepped, collector.Step());
      if (!stepped) break;
      if (progress_) progress_(done_ + collector.images_done(), total_);
    }
    done_ += order.size();
    if (is_first) {
      for (const CollectedFrame& frame : collector.frames()) rays_ += frame.progress.rays;
      skipped_.insert(skipped_.end(), collector.skipped().begin(), collector.skipped().end());
      for (const SkippedImage& image : collector.skipped())
        broken_.push_back(order[image.place].id);
    }
    pool_.ForEach(static_cast<size_t>(part.height()), [&](size_t row) {
      for (const SensorPlate& plate : plates)
        values->AddRow(plate, part.y_begin + static_cast<int>(row));
    });
    return {};
  }

  void LeaveOutBroken() {
    std::erase_if(order_, [&](const SelectedImage& image) {
      return std::find(broken_.begin(), broken_.end(), image.id) != broken_.end();
    });
    for (SkippedImage& image : skipped_) image.place = 0;
    total_ = done_ + (total_ / std::max<size_t>(1, done_) - 1) * order_.size();
  }

  void TakeRow(int y, ElementValues* values) {
    std::vector<RankedRay> rays;
    for (int x = 0; x < width_; ++x) {
      const uint32_t count = values->Count(x, y);
      counts_.at(x, y) = count;
      if (count == 0) continue;
      const RankRange ranks = RanksOf(options_.statistic, options_.trim, count);
      if (options_.order == StatisticOrder::kChannels) {
        for (size_t c = 0; c < values->channels(); ++c)
          plate_.Add(x, y, static_cast<int>(c), SumOfRanks(values->Values(x, y, c), ranks));
        continue;
      }
      TakeByLuminance(x, y, ranks, values, &rays);
    }
  }

  void TakeByLuminance(int x, int y, const RankRange& ranks, ElementValues* values,
                       std::vector<RankedRay>* rays) {
    const bool has_opacity = kind_ == PlateKind::kOpacity;
    rays->clear();
    for (uint32_t i = 0; i < values->Count(x, y); ++i)
      rays->emplace_back(
          values->Values(x, y, 0)[i], values->Values(x, y, 1)[i], values->Values(x, y, 2)[i],
          has_opacity ? values->Values(x, y, SensorPlate::kOpacityChannel)[i] : uint16_t{0});
    PutRanksInPlace(*rays, ranks);
    const uint64_t count = ranks.end - ranks.begin;
    std::array<uint64_t, 4> sums = {};
    for (size_t i = ranks.begin; i < ranks.end; ++i) {
      const RankedRay& ray = (*rays)[i];
      sums[0] += ray.red();
      sums[1] += ray.green();
      sums[2] += ray.blue;
      sums[3] += ray.opacity;
    }
    for (size_t c = 0; c < values->channels(); ++c)
      plate_.Add(x, y, static_cast<int>(c), {sums[c], count});
  }

  const LightField& light_field_;
  const LfImageStore& store_;
  const RenderCamera& camera_;
  const RayReading& reading_;
  const LensStatisticOptions& options_;
  ThreadPool& pool_;
  const std::function<void(size_t, size_t)>& progress_;
  const int width_, height_;
  const PlateKind kind_;
  MemoryPlan plan_;
  std::vector<SelectedImage> order_;
  SensorPlate plate_;       // sums and counts of the ranks that the statistic takes
  Image<uint32_t> counts_;  // number of values of each element
  FrameRays rays_;
  std::vector<SkippedImage> skipped_;
  std::vector<LfImageId> broken_;
  size_t done_ = 0, total_ = 0;  // LF images, counted once for each part
};

}  // namespace

const char* NameOf(LensStatistic statistic) {
  switch (statistic) {
    case LensStatistic::kMin:
      return "min";
    case LensStatistic::kMax:
      return "max";
    case LensStatistic::kMedian:
      return "median";
    case LensStatistic::kTrimmed:
      return "trimmed";
    case LensStatistic::kMean:
      break;
  }
  return "mean";
}

const char* NameOf(StatisticOrder order) {
  return order == StatisticOrder::kChannels ? "channels" : "luminance";
}

ImageMetadata StatisticMetadata(const LensStatisticOptions& options) {
  ImageMetadata metadata = {{"lf:statistic", std::string(NameOf(options.statistic))},
                            {"lf:statistic_order", std::string(NameOf(options.order))}};
  if (options.statistic == LensStatistic::kTrimmed)
    metadata.emplace_back("lf:statistic_trim", options.trim);
  return metadata;
}

RunInputs InputsOfStatistic(const LensStatisticOptions& options) {
  RunInputs inputs = {{"statistic", NameOf(options.statistic)},
                      {"statistic.order", NameOf(options.order)}};
  if (options.statistic == LensStatistic::kTrimmed)
    inputs.emplace_back("statistic.trim", fmt::format("{}", options.trim));
  return inputs;
}

Result<void> CheckStatisticLens(const RenderCamera& camera) {
  if (camera.transmission)
    return UsageError(
        "the lens has a transmission (lens.transmission in the path), which has no share in an "
        "order of rays: leave it out");
  return {};
}

Result<StatisticRenderer> StatisticRenderer::Open(LightField light_field,
                                                  const LensStatisticOptions& options) {
  LF_RETURN_IF_ERROR(CheckOptions(options));
  StatisticRenderer opened(std::move(light_field), options);
  LightField& field = *opened.light_field_;
  RayReading& reading = opened.reading_;
  // Prefilters and cubics undershoot and overshoot beside edges, and extremes would show just this.
  const bool is_extreme =
      options.statistic == LensStatistic::kMin || options.statistic == LensStatistic::kMax;
  reading.filter = is_extreme && options.filter == PixelFilter::kAuto
                       ? PixelFilter::kBilinear
                       : FilterOf(options.filter, field.encoding, true);
  reading.footprint = options.footprint;
  if (reading.Prefilters())
    MakeRoomBesideEdges(field.image_names, &field.encoding);
  else
    MakeRoomForUndershoot(&field.encoding);
  LF_ASSIGN_OR_RETURN(opened.store_, OpenStore(field, Mosaics::kToRgb));
  if (reading.Prefilters() && !reading.footprint) {
    LF_ASSIGN_OR_RETURN(reading.footprint, FootprintOf(field, *opened.store_));
  }
  return opened;
}

Result<StatisticFrame> StatisticRenderer::Make(
    FrameId id, const RenderCamera& camera, ThreadPool& pool,
    const std::function<void(size_t, size_t)>& progress) const {
  LF_RETURN_IF_ERROR(CheckStatisticLens(camera));
  return StatisticMaker(*light_field_, *store_, camera, reading_, options_, pool, progress)
      .Make(id);
}

Result<StatisticFrame> MakeStatisticFrame(LightField light_field, FrameId id,
                                          const RenderCamera& camera,
                                          const LensStatisticOptions& options, ThreadPool& pool,
                                          const std::function<void(size_t, size_t)>& progress) {
  LF_RETURN_IF_ERROR(CheckStatisticLens(camera));
  LF_ASSIGN_OR_RETURN(const StatisticRenderer renderer,
                      StatisticRenderer::Open(std::move(light_field), options));
  return renderer.Make(id, camera, pool, progress);
}

}  // namespace lf
