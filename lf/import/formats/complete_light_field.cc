// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/complete_light_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/log.h"
#include "lf/light_field/model/alpha_evidence.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/masks_beside.h"
#include "lf/light_field/model/raw_encoding.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;

Result<void> CompleteEncoding(const OpenOptions& options, const fs::path& path,
                              LightField* light_field) {
  RadianceEncoding& encoding = light_field->encoding;
  const bool is_raw = IsRawName(light_field->image_names[0]);
  // If Bayer pattern or transfer differ from their defaults, the calibration has stated the
  // encoding completely.
  if (is_raw && encoding.bayer == BayerPattern::kNone && encoding.transfer == Transfer::kSrgb)
    LF_RETURN_IF_ERROR(CompleteEncodingOfRaw(light_field));
  if (options.bayer) {
    if (encoding.transfer == Transfer::kSrgb) encoding.transfer = Transfer::kLinear;
    encoding.bayer = *options.bayer;
  }
  if (!is_raw || encoding.bayer != BayerPattern::kNone) return {};
  LF_ASSIGN_OR_RETURN(const std::optional<RawFacts> facts, RawFactsOfFirstImage(*light_field));
  if (facts && facts->is_monochrome) return {};
  return InputError(
      fmt::format("{}: the camera raw file {} does not state a Bayer pattern (four letters of R, "
                  "G, B with the two G on a diagonal): state the pattern in transforms.json, such "
                  "as \"lf_bayer\": \"RGGB\", or import with {{lfimport bayer RGGB}}",
                  path.string(), light_field->ImagePath({0}).string()));
}

Result<void> FindImages(const OpenOptions& options, const fs::path& path, LightField* light_field) {
  const std::string name = light_field->image_names[0];
  LF_ASSIGN_OR_RETURN(const size_t found_count, FindImageFiles(options.images_folder, light_field));
  // Without --images, missing files are no error: a COLMAP model may be used for planning before
  // its images are there.
  if (found_count == 0 && options.images_folder && light_field->folder != *options.images_folder)
    return InputError(
        fmt::format("{{images {}}}: neither this folder nor one below it contains an image that {} "
                    "names, such as {}: give the folder of these images",
                    options.images_folder->string(), path.string(), name));
  const Intrinsics before = light_field->intrinsics[0];
  LF_ASSIGN_OR_RETURN(const double factor, FitToImageFiles(options.image_scale, light_field));
  if (factor != 1)
    LogInfo(
        "{}: image files are {:.4g} times as large as the calibration says, such as {} x {} pixels "
        "instead of {} x {}: the intrinsics are scaled accordingly (see {{image_scale}})",
        path.string(), factor, light_field->intrinsics[0].width_px,
        light_field->intrinsics[0].height_px, before.width_px, before.height_px);
  return {};
}

Result<void> FindMasks(const OpenOptions& options, LightField* light_field) {
  if (!options.masks_folder) return {};
  std::vector<std::string> masks = MasksIn(fs::absolute(*options.masks_folder), *light_field);
  if (masks.empty())
    return InputError(fmt::format(
        "{{masks {}}}: holds no mask of an image, such as {}.png for {}: give the folder of the "
        "masks",
        options.masks_folder->string(), fs::path(light_field->image_names[0]).filename().string(),
        light_field->image_names[0]));
  light_field->mask_names = std::move(masks);
  return {};
}

Result<void> CompleteAlpha(const OpenOptions& options, const fs::path& path,
                           LightField* light_field) {
  RadianceEncoding& encoding = light_field->encoding;
  const bool was_light = encoding.AlphaIsLight();
  if (options.alpha && HoldsPackedStore(*light_field) &&
      was_light != (*options.alpha != AlphaMeaning::kMask))
    return UsageError(
        fmt::format("{{image_alpha {}}}: {} is a packed store, whose alpha was stored as {} and "
                    "cannot be changed: compress the original image files again with this option",
                    NameOf(*options.alpha), path.string(), was_light ? "opacity" : "a mask"));
  if (options.alpha) encoding.alpha = options.alpha;
  if (options.background) {
    encoding.background = options.background;
    encoding.keeps_opacity = options.keeps_opacity;
  }
  if (!encoding.alpha && !HoldsPackedStore(*light_field) && encoding.bayer == BayerPattern::kNone) {
    if (const std::optional<AlphaEvidence> found = FindAlphaEvidence(*light_field)) {
      encoding.alpha = found->meaning;
      if (encoding.AlphaIsLight() && !encoding.background) encoding.background = found->background;
      const std::string meaning =
          TextOfAlpha(*encoding.alpha, encoding.Background(), encoding.keeps_opacity);
      if (found->is_sure)
        LogInfo("{}: alpha is taken as {}, because {} ({{image_alpha}} overrides this)",
                path.string(), meaning, found->reason);
      else
        LogWarning(
            "{}: the program is not sure what alpha means: {}. Alpha is taken as {}. If edges or "
            "surroundings look wrong, add {{image_alpha mask}}, straight or premultiplied",
            path.string(), found->reason, meaning);
    }
  }
  if (!encoding.background) return {};
  if (encoding.keeps_opacity && encoding.bayer != BayerPattern::kNone)
    return UsageError(fmt::format(
        "{{background {}}}: the LF images of {} are mosaics, which have no alpha: leave "
        "the option out",
        kNoBackground, path.string()));
  if (!encoding.AlphaIsLight())
    return UsageError(fmt::format(
        "{{background}}: a background has no effect on the LF images of {}, because their alpha is "
        "{}: leave the option out{}",
        path.string(), encoding.alpha ? "a mask" : "unknown or absent",
        HoldsPackedStore(*light_field) || encoding.bayer != BayerPattern::kNone
            ? ""
            : ", or add {image_alpha straight} or premultiplied"));
  const auto& behind = *encoding.background;
  if (*std::max_element(behind.begin(), behind.end()) > encoding.max_radiance)
    return UsageError(
        fmt::format("the background {} of {} is brighter than lf_max_radiance, {}: give a darker "
                    "one ({{background}})",
                    fmt::join(behind, ","), path.string(), encoding.max_radiance));
  return {};
}

}  // namespace lf
