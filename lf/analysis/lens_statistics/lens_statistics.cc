// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/lens_statistics.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "lf/analysis/lens_statistics/statistic_film.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/film_setup.h"

namespace lf {
namespace {

Error NoCamera() {
  return InputError(
      "no LF camera has a ray through the lens of the frame: open the aperture "
      "(lens.aperture_diameter in the path), or move the camera to the LF cameras");
}

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

Result<StatisticFrame> MakeStatisticFrame(LightField light_field, FrameId id,
                                          const RenderCamera& camera,
                                          const LensStatisticOptions& options, ThreadPool& pool,
                                          const std::function<void(size_t, size_t)>& progress) {
  StatisticFilm film(options);
  const RenderOptions render = RenderOptionsOf(options, light_field.encoding);
  CameraPath path;
  path.cameras = {camera};
  Package package = PackageOfAll(std::move(light_field), std::move(path), render.film.seed);
  package.choices.max_angle_rad = options.max_angle_rad;
  LF_RETURN_IF_ERROR(film.Check(package, render));
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<FilmSetup> setup,
                      FilmSetup::Make(std::move(package), render.film, render.work, {}, pool));
  LF_ASSIGN_OR_RETURN(const PassPlan plan, film.Plan(setup.get(), setup->frames()));
  const std::unique_ptr<FrameSource> source = film.Open(*setup, setup->frames());
  LF_RETURN_IF_ERROR(source->Begin(nullptr, {}));
  if (source->images().empty()) return NoCamera();
  for (bool is_going_on = true; is_going_on;) {
    LF_ASSIGN_OR_RETURN(is_going_on, source->Step());
    if (progress) progress(source->progress().image_count, source->total().image_count);
  }
  StatisticFrame frame;
  frame.notes = source->NotesOf(0);
  frame.notes.frame = id;
  frame.skipped.assign(source->skipped().begin(), source->skipped().end());
  if (frame.notes.rays.image_count == 0 && frame.skipped.empty()) return NoCamera();
  frame.picture = source->Develop(0, {}, false, [&] { return setup->work().IsStopped(); }).picture;
  if (setup->work().IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  frame.keeps_opacity = setup->light_field().encoding.HasOpacity();
  frame.image_count = source->images().size();
  frame.part_count = plan.readings;
  return frame;
}

}  // namespace lf
