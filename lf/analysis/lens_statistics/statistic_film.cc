// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/statistic_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "lf/analysis/lens_statistics/element_values.h"
#include "lf/analysis/lens_statistics/statistic_source.h"
#include "lf/core/byte_text.h"
#include "lf/render/collect/collected_frame.h"
#include "lf/render/settings/interpolation.h"

namespace lf {
namespace {

constexpr size_t kMostPlates = 16;  // plates, each of one LF image, of a frame that are in memory
constexpr size_t kMiB = size_t{1} << 20;

// Divides the memory for frames that take up to `image_count` LF images, at least 1.
Result<StatisticPlan> PlanOf(const FilmSetup& setup, const RenderCamera& camera,
                             size_t image_count) {
  const size_t memory_bytes = setup.work().memory_bytes;
  const int width = camera.pinhole.intrinsics.width_px;
  const int height = camera.pinhole.intrinsics.height_px;
  const PlateKind kind = PlateKindOf(setup.light_field().encoding, false);
  const size_t result_bytes =
      static_cast<size_t>(width) * height * (static_cast<size_t>(kind) * 8 + 4);
  const size_t row_bytes = ElementValues::BytesOfRow(width, static_cast<int>(kind), image_count);
  const auto plan_for = [&](size_t bytes, size_t plates, size_t other_bytes) {
    return PlanMemory(bytes, setup.light_field(), setup.film().reading, width, height, plates,
                      setup.pool().thread_count(), other_bytes, false, 1, camera.surface.get(),
                      setup.References());
  };
  // Refuses what does not suffice for the values of one row of elements.
  LF_RETURN_IF_ERROR(plan_for(memory_bytes, 1, result_bytes + row_bytes));
  const auto others = [&](const MemoryPlan& collect) { return collect.total_bytes + result_bytes; };
  // A quarter of the memory is for LF images and their plates, more only if they need it.
  Result<MemoryPlan> collect = plan_for(memory_bytes / 4, std::min(kMostPlates, image_count), 0);
  if (!collect || memory_bytes < others(*collect) + row_bytes)
    collect = plan_for(memory_bytes - result_bytes - row_bytes, 1, 0);
  if (!collect) return collect.error();
  StatisticPlan plan;
  plan.collect = *collect;
  const size_t rows = (memory_bytes - others(*collect)) / row_bytes;
  plan.rows = static_cast<int>(std::min(rows, static_cast<size_t>(height)));
  if (plan.rows < height) return plan;
  // Further frames share the reading of the LF images, if their values fit.
  const size_t values_bytes = static_cast<size_t>(height) * row_bytes;
  const size_t plates_bytes = collect->frames_per_pass * collect->plate_bytes;
  plan.frames_per_pass = 1 + (memory_bytes - others(*collect) - values_bytes) /
                                 (values_bytes + plates_bytes + result_bytes);
  return plan;
}

Result<void> CheckOptions(const LensStatisticOptions& options) {
  if (options.statistic == LensStatistic::kTrimmed && !(options.trim >= 0 && options.trim < 0.5))
    return UsageError(fmt::format(
        "the share {:g} is to be cut at each end: expected a number from 0 to below 0.5",
        options.trim));
  if (options.filter == PixelFilter::kMosaic)
    return UsageError(
        "the filter mosaic cannot be used for statistics over the lens, because it corrects "
        "mosaics for means of many rays: use auto or another filter");
  return {};
}

// Refuses what has no meaning for a statistic.
Result<void> CheckSettings(const RenderOptions& options) {
  const FilmSettings& film = options.film;
  if (film.shard)
    return UsageError(
        "{shard}: a statistic over the lens needs all values of an element together, and the "
        "statistics of parts of the LF images cannot be added: divide the frames with {frames} or "
        "packages, or take fewer LF images with {max_images}");
  if (film.HasStopRule() || film.require.samples || film.require.noise)
    return UsageError(
        "{stop_when}, {require}: the rules measure sums of rays and the noise of their mean, which "
        "a statistic over the lens does not have: leave them out, or take fewer LF images with "
        "{max_images}");
  if (film.Rebins())
    return UsageError(fmt::format(
        "{{mode {}}}: rebinned rays are interpolated, and have no share in an order of recorded "
        "rays: use {}",
        NameOf(film.mode), CollectInstead(film)));
  if (options.folder.keep_plates || !options.folder.finish_early.empty())
    return UsageError(
        "{keep_plates}, {finish}: a statistic over the lens has no sums that could be kept or "
        "continued: leave them out");
  return {};
}

// Returns the filter that options.filter stands for.
PixelFilter StatisticFilter(const LensStatisticOptions& options, const RadianceEncoding& encoding) {
  // Prefilters and cubics undershoot and overshoot beside edges, and extremes would show just this.
  const bool is_extreme =
      options.statistic == LensStatistic::kMin || options.statistic == LensStatistic::kMax;
  if (is_extreme && options.filter == PixelFilter::kAuto) return PixelFilter::kBilinear;
  // The correction of a mosaic is made for means of many rays.
  const PixelFilter filter = FilterOf(options.filter, encoding);
  return filter == PixelFilter::kMosaic ? PixelFilter::kPrefiltered : filter;
}

}  // namespace

RenderOptions RenderOptionsOf(const LensStatisticOptions& options,
                              const RadianceEncoding& encoding) {
  RenderOptions render;
  FilmSettings& film = render.film;
  film.reading = Estimator::kBilinear;
  film.reading.filter = StatisticFilter(options, encoding);
  film.reading.footprint = options.footprint;
  film.lens_weights = LensWeights::kNone;
  film.guard = false;  // virtual LF images are left out
  film.max_angle_rad = options.max_angle_rad;
  film.max_image_count = options.max_image_count;
  film.adds_opacity = options.adds_opacity;
  render.work.memory_bytes = options.memory_bytes;
  render.work.strict = options.strict;
  render.work.interrupted = render.work.stop = options.stop;
  return render;
}

StatisticFilm::StatisticFilm(const LensStatisticOptions& options) : options_(options) {}
StatisticFilm::~StatisticFilm() = default;

Result<void> StatisticFilm::Check(const Package& package, const RenderOptions& options) const {
  LF_RETURN_IF_ERROR(CheckOptions(options_));
  LF_RETURN_IF_ERROR(CheckSettings(options));
  if (package.path.shutter.exists())
    return UsageError(
        "the path has a shutter, whose blur has no share in an order of rays: leave the shutter "
        "out");
  for (const FrameId frame : options.frames.empty() ? package.FrameIds() : options.frames)
    LF_RETURN_IF_ERROR(CheckStatisticLens(package.path.Camera(frame)));
  return {};
}

Result<PassPlan> StatisticFilm::Plan(FilmSetup* setup, std::span<const FrameId> frames) {
  const SelectOptions select = setup->Select();
  size_t most = 1;
  for (const FrameId frame : frames) {
    const TakingFrame taking = TakingOf(*setup, frame);
    most = std::max(
        most, SelectImages(setup->index().recorded(), std::span(&taking, 1), select, setup->pool())
                  .size());
    if (setup->work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  }
  const RenderCamera& camera = setup->path().Camera(frames.front());
  LF_ASSIGN_OR_RETURN(const StatisticPlan plan, PlanOf(*setup, camera, most));
  plan_ = std::make_unique<StatisticPlan>(plan);
  if (plan.collect.reference_bytes > 0) setup->LimitReferences(plan.collect.reference_bytes);
  const int height = camera.pinhole.intrinsics.height_px;
  const bool is_whole = plan.rows == height;
  return PassPlan{plan.frames_per_pass, plan.collect.frames_finished_at_once,
                  static_cast<size_t>((height + plan.rows - 1) / plan.rows),
                  is_whole ? fmt::format("the values of {} frames", plan.frames_per_pass)
                           : fmt::format("the values of {} of {} rows", plan.rows, height)};
}

std::unique_ptr<FrameSource> StatisticFilm::Open(const FilmSetup& setup,
                                                 std::span<const FrameId> frames) const {
  return std::make_unique<StatisticSource>(setup, options_, *plan_, frames);
}

}  // namespace lf
