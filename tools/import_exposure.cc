// SPDX-License-Identifier: Apache-2.0
#include "tools/import_exposure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/common/progress.h"

#include "lf/light_field/model/brackets.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_file.h"

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
         fmt::format("{} of {} images keep their lf_gain, because it cannot be estimated to 2 % "
                     "from what other images show of the same places: state lf_gain for images "
                     "that are too dark or too bright",
                     exposure.left_alone.size(), light_field.size()),
         exposure.left_alone);
  if (!exposure.unreadable.empty())
    warn("exposure-left-alone",
         fmt::format("{} of {} images cannot be read, and keep their lf_gain",
                     exposure.unreadable.size(), light_field.size()),
         exposure.unreadable);
  if (exposure.component_count > 1)
    warn("exposure-apart",
         fmt::format("the images form {} groups that do not overlap: each was matched by itself, "
                     "so that one may be brighter than another; if so, multiply lf_gain of all "
                     "images of a group by one factor",
                     exposure.component_count),
         {});
  if (arguments.vignetting && !exposure.falloff)
    warn("no-falloff",
         "no falloff of a lens fits the samples, which do not reach the corners, or differ for "
         "another reason; lf_vignetting stays as it was",
         {});
}

// Returns the LF images whose files are asked for their exposure: all if `asks_all` is true,
// otherwise those that share their pose with another one.
std::vector<LfImageId> ImagesToAsk(const LightField& light_field, bool asks_all) {
  std::vector<bool> is_asked(light_field.size(), asks_all);
  if (!asks_all) {
    const std::vector<uint32_t> firsts = FirstOfPose(light_field);
    for (uint32_t i = 0; i < firsts.size(); ++i)
      if (firsts[i] != i) is_asked[i] = is_asked[firsts[i]] = true;
  }
  std::vector<LfImageId> ids;
  for (uint32_t i = 0; i < is_asked.size(); ++i)
    if (is_asked[i]) ids.push_back(LfImageId{i});
  return ids;
}

// Returns exposures in stops as text, such as "-2, 0 and +2", rounded to hundredths.
std::string StopsText(const std::vector<double>& stops) {
  std::string text;
  for (size_t i = 0; i < stops.size(); ++i) {
    const double rounded = std::round(100 * stops[i]) / 100 + 0.0;
    text += i == 0 ? "" : i + 1 == stops.size() ? " and " : ", ";
    text += rounded > 0 ? fmt::format("+{}", rounded) : fmt::format("{}", rounded);
  }
  return text;
}

}  // namespace

void ExposureArguments::AddTo(CLI::App& app) {
  OptionGroup picture(app, kPictureGroup);
  CLI::Option* const option = picture.AddFlag(
      "--match-exposure", match,
      "Make the LF images equally bright\n"
      "Estimates a brightness factor (lf_gain) for each image and colour channel, from parts of "
      "the scene that neighbouring images both show. The factors replace lf_gain in the "
      "transforms.json that -o writes; without -o only their range is reported. See "
      "doc/inputs.md.");
  picture
      .AddFlag("--vignetting", vignetting,
               "Correct the darkening towards the corners\n"
               "In addition to lf_gain, estimates lf_vignetting of each lens: how much darker it "
               "images the corners than the centre.")
      ->needs(option);
  picture
      .AddFlag("--gain-from-exif", gain_from_exif,
               "Take the exposure of each image from its file\n"
               "Computes lf_gain of each image from the exposure time, f-number and ISO "
               "sensitivity in its file (Exif data), relative to the image of median exposure. The "
               "result replaces the lf_gain of LIGHTFIELD.")
      ->excludes(option);
  picture.AddFlag(
      "--mask-clipped", mask_clipped,
      "Merge images of one pose with different exposures\n"
      "Writes \"lf_clipped\": \"mask\" into transforms.json. Renders then take each pixel from the "
      "brightest image of the pose in which it is not clipped (overexposed). Needs the exposures "
      "(lf_gain) of the images, for example by --gain-from-exif.");
}

Result<std::optional<ExifGains>> StateBrackets(const ExposureArguments& arguments, ThreadPool& pool,
                                               LightField* light_field,
                                               std::vector<double>* lights) {
  lights->clear();
  if (HoldsPackedStore(*light_field)) {
    if (!arguments.gain_from_exif && !arguments.mask_clipped) return std::optional<ExifGains>();
    return UsageError(fmt::format(
        "{} cannot be used with {}, because a packed store contains no Exif data, and its masks "
        "cannot be changed: give this option to lfimport for the image files, and compress them "
        "again",
        arguments.gain_from_exif ? "--gain-from-exif" : "--mask-clipped",
        light_field->folder.string()));
  }
  const std::vector<StatedExposure> stated =
      ReadStatedExposures(*light_field, ImagesToAsk(*light_field, arguments.gain_from_exif), pool);
  if (!stated.empty())
    lights->resize(light_field->size(), std::numeric_limits<double>::quiet_NaN());
  for (const StatedExposure& one : stated) (*lights)[one.id.value] = LightOf(one.facts);
  std::optional<ExifGains> gains;
  if (arguments.gain_from_exif) {
    LF_ASSIGN_OR_RETURN(gains, GainFromExif(stated, light_field));
  }
  if (arguments.mask_clipped) light_field->encoding.masks_clipped = true;
  ApplyBrackets(light_field);  // once more, because --exclude and gains changed the light field
  return gains;
}

void WarnOfBracketOptions(const ExposureArguments& arguments, const std::optional<ExifGains>& gains,
                          LightField* light_field, CaptureReport* report) {
  const auto warn = [&](const char* kind, const char* message) {
    report->warnings.push_back(WarningAbout(*light_field, kind, message, {}));
  };
  if (arguments.match && light_field->encoding.masks_clipped) {
    const auto matched = FindBrackets(*light_field, FirstOfPose(*light_field), {});
    if (matched) {
      report->brackets = matched;
      std::erase_if(report->warnings, [&](const CaptureWarning& warning) {
        return warning.kind == "brackets" || (warning.kind == "repeated-positions" &&
                                              warning.image_count <= matched->image_count);
      });
    }
  }
  if (gains && !gains->has_f_numbers)
    warn("no-f-number",
         "no image states an f-number (lenses without contacts do not report it): all images are "
         "assumed to have the same; state lf_gain where the aperture was changed");
  if (ApplyBrackets(light_field) == 0 && arguments.mask_clipped)
    warn("no-brackets",
         "--mask-clipped masks nothing, because no image has a darker image of the same pose (by "
         "lf_gain). Give the images of one pose the same transform_matrix, and their gains "
         "(--gain-from-exif, --match-exposure)");
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

std::string BracketsText(const FoundBrackets& brackets) {
  const std::string exposures =
      brackets.least_exposures == brackets.most_exposures
          ? fmt::format("{}", brackets.most_exposures)
          : fmt::format("{} to {}", brackets.least_exposures, brackets.most_exposures);
  return fmt::format("{} poses x {} exposures, {} stops by {}", brackets.pose_count, exposures,
                     StopsText(brackets.stops),
                     brackets.are_gains ? "lf_gain" : "what the files state");
}

std::string ExifGainsText(const ExifGains& gains) {
  return fmt::format("{:.5g} to {:.5g} for {} images, from the exposure that their files state",
                     gains.least_gain, gains.most_gain, gains.image_count);
}

nlohmann::ordered_json BracketsJson(const FoundBrackets& brackets) {
  return {{"poses", brackets.pose_count},
          {"images", brackets.image_count},
          {"exposures", {brackets.least_exposures, brackets.most_exposures}},
          {"stops", brackets.stops},
          {"from", brackets.are_gains ? "lf_gain" : "files"}};
}

nlohmann::ordered_json ExifGainsJson(const ExifGains& gains) {
  return {{"images", gains.image_count},
          {"gain_min", gains.least_gain},
          {"gain_max", gains.most_gain},
          {"has_f_numbers", gains.has_f_numbers}};
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
      "{} % of the light is left in the corners; a tenth of the compared places lie "
      "beyond {:.2f} of the distance from the axis to the corners",
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
