#include "tools/import_exposure.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "tools/common/progress.h"

#include "lf/store/open_store.h"

namespace lf {
namespace {

size_t MatchedCount(const MatchedExposure& exposure) {
  return exposure.gains.size() - exposure.left_alone.size() - exposure.unreadable.size();
}

void Warn(const LightField& light_field, const ExposureArguments& arguments,
          const MatchedExposure& exposure, CaptureReport* report) {
  const auto warn = [&](const char* kind, const std::string& message,
                        const std::vector<LfImageId>& ids) {
    report->warnings.push_back(WarningAbout(light_field, kind, message, ids));
  };
  if (!exposure.left_alone.empty())
    warn("exposure-left-alone",
         fmt::format("{} of {} images show too little of what others show, and keep the lf_gain "
                     "they had: state it where they are too dark or too bright",
                     exposure.left_alone.size(), light_field.size()),
         exposure.left_alone);
  if (!exposure.unreadable.empty())
    warn("exposure-left-alone",
         fmt::format("{} of {} images cannot be read, and keep the lf_gain they had",
                     exposure.unreadable.size(), light_field.size()),
         exposure.unreadable);
  if (exposure.component_count > 1)
    warn("exposure-apart",
         fmt::format("the images are {} groups that do not overlap: each was matched by itself, "
                     "and one may be brighter than another",
                     exposure.component_count),
         {});
  if (arguments.vignetting && !exposure.falloff)
    warn("no-falloff",
         "no falloff of a lens was found that fits: the samples do not reach the corners, or tell "
         "of something else; lf_vignetting stays as it was",
         {});
}

}  // namespace

void ExposureArguments::AddTo(CLI::App& app) {
  const char* group = "Uneven exposure (doc/inputs.md)";
  CLI::Option* const option =
      app.add_flag("--match-exposure", match,
                   "Estimate lf_gain of each image and channel from what neighbouring images both "
                   "show, in place of those of LIGHTFIELD; without -o only the report says them")
          ->group(group);
  app.add_flag(
         "--vignetting", vignetting,
         "Estimate lf_vignetting of each camera as well: how much light its lens loses towards "
         "the corners")
      ->needs(option)
      ->group(group);
}

Result<MatchedExposure> MatchAndApply(const ExposureArguments& arguments,
                                      const CommonOptions& common,
                                      const std::atomic<bool>& interrupted, ThreadPool& pool,
                                      LightField* light_field, CaptureReport* report) {
  const LightField plain = WithoutExposure(*light_field);
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store, OpenStore(plain, Mosaics::kToRgb));
  ProgressMeter meter(ParseProgressStyle(common.progress), "images");
  MatchExposureOptions options;
  options.vignetting = arguments.vignetting;
  options.interrupted = &interrupted;
  options.progress = [&](size_t done, size_t total) {
    meter.Update(done, total, "matching exposure");
  };
  LF_ASSIGN_OR_RETURN(MatchedExposure exposure, MatchExposure(*light_field, *store, options, pool));
  ApplyExposure(exposure, light_field);
  Warn(*light_field, arguments, exposure, report);
  return exposure;
}

std::string ExposureText(const MatchedExposure& exposure) {
  return fmt::format(
      "{} of {} images matched by {} colours of places that two of them show: gains "
      "{:.3f} to {:.3f}",
      MatchedCount(exposure), exposure.gains.size(), exposure.sample_count, exposure.least_gain,
      exposure.most_gain);
}

std::string SeamsText(const MatchedExposure& exposure) {
  return fmt::format("{:.2f} % between neighbouring images before, {:.2f} % after",
                     100 * exposure.step_before, 100 * exposure.step_after);
}

std::string FalloffText(const FoundFalloff& falloff) {
  const std::string min = fmt::format("{:.1f}", 100 * falloff.corner_min);
  const std::string max = fmt::format("{:.1f}", 100 * falloff.corner_max);
  return fmt::format(
      "{} % of the light is left in the corners; a tenth of the places lie beyond "
      "{:.2f} of the way there",
      min == max ? min : fmt::format("{} to {}", min, max), falloff.reach);
}

nlohmann::ordered_json ExposureJson(const MatchedExposure& exposure) {
  nlohmann::ordered_json json = {
      {"matched", MatchedCount(exposure)}, {"groups", exposure.component_count},
      {"samples", exposure.sample_count},  {"gain_min", exposure.least_gain},
      {"gain_max", exposure.most_gain},    {"step_before", exposure.step_before},
      {"step_after", exposure.step_after}, {"falloff", nullptr}};
  if (exposure.falloff)
    json["falloff"] = {{"corner_min", exposure.falloff->corner_min},
                       {"corner_max", exposure.falloff->corner_max},
                       {"reach", exposure.falloff->reach},
                       {"cameras", exposure.falloff->camera_count}};
  return json;
}

}  // namespace lf
