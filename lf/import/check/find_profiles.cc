// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/find_profiles.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/pixels/files/colour_profile.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

std::optional<FoundProfile> FindProfile(const LightField& light_field) {
  constexpr size_t kMostAsked = 15;
  if (HoldsPackedStore(light_field)) return std::nullopt;
  FoundProfile found;
  found.asked_count = std::min(kMostAsked, light_field.size());
  for (size_t i = 0; i < found.asked_count; ++i) {
    const auto index = static_cast<uint32_t>(i * light_field.size() / found.asked_count);
    const Result<std::string> icc = ReadIccProfile(light_field.ImagePath(LfImageId{index}));
    if (!icc || !IsOtherThanSrgb(*icc)) continue;
    if (found.image_count++ == 0) found.name = NameOfProfile(*icc);
  }
  if (found.image_count == 0) return std::nullopt;
  found.is_converted = light_field.encoding.transfer == Transfer::kSrgb &&
                       light_field.encoding.bayer == BayerPattern::kNone;
  return found;
}

std::string TextOf(const FoundProfile& profile) {
  return fmt::format("{} in {} of {} examined images, {}", profile.name, profile.image_count,
                     profile.asked_count,
                     profile.is_converted
                         ? "converted to sRGB"
                         : "not converted, because the calibration states how pixels encode light");
}

}  // namespace lf
