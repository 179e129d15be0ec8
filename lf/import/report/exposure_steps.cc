// SPDX-License-Identifier: Apache-2.0
#include "lf/import/report/exposure_steps.h"

#include <fmt/format.h>

#include <limits>
#include <memory>

#include "lf/light_field/model/brackets.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

void Warn(const LightField& light_field, const ExposureSteps& steps,
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
  if (steps.vignetting && !exposure.falloff)
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

}  // namespace

Result<std::optional<ExifGains>> StateBrackets(const ExposureSteps& steps, ThreadPool& pool,
                                               LightField* light_field,
                                               std::vector<double>* lights) {
  lights->clear();
  if (HoldsPackedStore(*light_field)) {
    if (!steps.gain_from_exif && !steps.mask_clipped) return std::optional<ExifGains>();
    return UsageError(fmt::format(
        "{} cannot be used with {}, because a packed store contains no Exif data, and its masks "
        "cannot be changed: give this option to lfimport for the image files, and compress them "
        "again",
        steps.gain_from_exif ? "{gain_from_exif}" : "{mask_clipped}",
        light_field->folder.string()));
  }
  const std::vector<StatedExposure> stated =
      ReadStatedExposures(*light_field, ImagesToAsk(*light_field, steps.gain_from_exif), pool);
  if (!stated.empty())
    lights->resize(light_field->size(), std::numeric_limits<double>::quiet_NaN());
  for (const StatedExposure& one : stated) (*lights)[one.id.value] = LightOf(one.facts);
  std::optional<ExifGains> gains;
  if (steps.gain_from_exif) {
    LF_ASSIGN_OR_RETURN(gains, GainFromExif(stated, light_field));
  }
  if (steps.mask_clipped) light_field->encoding.masks_clipped = true;
  ApplyBrackets(light_field);  // once more, because --exclude and gains changed the light field
  return gains;
}

void WarnOfBrackets(const ExposureSteps& steps, const std::optional<ExifGains>& gains,
                    LightField* light_field, CaptureReport* report) {
  const auto warn = [&](const char* kind, const char* message) {
    report->warnings.push_back(WarningAbout(*light_field, kind, message, {}));
  };
  if (steps.match && light_field->encoding.masks_clipped) {
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
  if (ApplyBrackets(light_field) == 0 && steps.mask_clipped)
    warn("no-brackets",
         "{mask_clipped} masks nothing, because no image has a darker image of the same pose (by "
         "lf_gain). Give the images of one pose the same transform_matrix, and their gains "
         "({gain_from_exif}, {match_exposure})");
}

Result<MatchedExposure> MatchAndApply(
    const ExposureSteps& steps, const std::atomic<bool>& interrupted,
    const std::function<void(size_t done, size_t total)>& progress, ThreadPool& pool,
    LightField* light_field, CaptureReport* report) {
  const LightField plain = WithoutExposure(*light_field);
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store, OpenStore(plain, Mosaics::kToRgb));
  MatchExposureOptions options;
  options.vignetting = steps.vignetting;
  options.interrupted = &interrupted;
  options.progress = progress;
  LF_ASSIGN_OR_RETURN(MatchedExposure exposure, MatchExposure(*light_field, *store, options, pool));
  ApplyExposure(exposure, light_field);
  Warn(*light_field, steps, exposure, report);
  return exposure;
}

}  // namespace lf
