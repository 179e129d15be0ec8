// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/unused_masks.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lf/light_field/model/masks_beside.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

// Returns the LF images without a mask that have one in `masks`.
std::vector<LfImageId> WithUnused(const std::vector<std::string>& masks,
                                  const LightField& light_field) {
  std::vector<LfImageId> ids;
  for (size_t i = 0; i < masks.size(); ++i)
    if (!masks[i].empty() && (light_field.mask_names.empty() || light_field.mask_names[i].empty()))
      ids.push_back(LfImageId{static_cast<uint32_t>(i)});
  return ids;
}

}  // namespace

std::optional<CaptureWarning> WarnOfUnusedMasks(const LightField& light_field,
                                                const CallAgain& import_again) {
  const auto& names = light_field.mask_names;
  const bool has_all = !names.empty() && std::find(names.begin(), names.end(), "") == names.end();
  if (has_all || HoldsPackedStore(light_field)) return std::nullopt;
  for (const std::filesystem::path& folder : FoldersOfMasks(light_field)) {
    const std::vector<LfImageId> ids = WithUnused(MasksIn(folder, light_field), light_field);
    if (ids.empty()) continue;
    return WarningAbout(
        light_field, "unused-masks",
        fmt::format(
            "{} holds masks of {} images that the calibration does not name; all pixels of "
            "these images are used. To leave out the pixels that are black in the masks: {}",
            folder.string(), ids.size(), import_again({"--masks", FileArgument(folder)})),
        ids);
  }
  const size_t dynamic_count = names.empty() ? CountDynamicMasks(light_field) : 0;
  if (dynamic_count == 0) return std::nullopt;
  return CaptureWarning{
      "unused-masks",
      fmt::format(
          "{} images have a dynamic_mask_NAME.png beside them, as instant-ngp names masks. "
          "These are white where pixels are to be left out, and are not used, because masks "
          "here are black there: write them inverted to a folder, as NAME.png, and give the "
          "folder with {{masks}}",
          dynamic_count),
      dynamic_count,
      {}};
}

}  // namespace lf
