// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/reduction.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/camera/resolution.h"

namespace lf {

Result<void> ReduceLightField(int divisor, LightField* light_field) {
  if (divisor != 1 && divisor != 2 && divisor != 4 && divisor != kMostReduction)
    return UsageError(fmt::format("{{reduce {}}}: expected 1, 2, 4 or 8", divisor));
  std::optional<Reduction>& reduction = light_field->reduction;
  if (divisor <= (reduction ? reduction->divisor : 1)) return {};
  if (HasVirtual(*light_field))
    return UsageError(fmt::format(
        "{{reduce}} cannot be used with {}, which is densified: leave the option out, or "
        "give the light field that it was made from",
        light_field->folder.string()));
  if (!reduction) reduction = Reduction{1, light_field->intrinsics, light_field->encoding.bayer};
  reduction->divisor = divisor;
  light_field->intrinsics.clear();
  for (const Intrinsics& k : reduction->recorded_intrinsics)
    light_field->intrinsics.push_back(WithLargerPixels(k, divisor));
  light_field->encoding.bayer = BayerPattern::kNone;
  light_field->encoding.footprint = PixelFootprint::kArea;
  return {};
}

LightField RecordedLightField(const LightField& light_field) {
  LightField recorded = light_field;
  if (!light_field.reduction) return recorded;
  recorded.intrinsics = light_field.reduction->recorded_intrinsics;
  recorded.encoding.bayer = light_field.reduction->recorded_bayer;
  recorded.reduction.reset();
  return recorded;
}

Result<void> CheckNotReduced(const LightField& light_field, const char* what) {
  if (!light_field.reduction) return {};
  return UsageError(
      fmt::format("{} needs whole LF images, but those of {} are loaded at 1/{} of their width and "
                  "height: leave "
                  "out {{reduce}}, or copy the missing files of the packed store",
                  what, light_field.folder.string(), light_field.reduction->divisor));
}

}  // namespace lf
