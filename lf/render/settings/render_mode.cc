// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/render_mode.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/core/value_named.h"

namespace lf {

const char* NameOf(RenderMode mode) {
  constexpr const char* kNames[] = {"collect", "rebin", "hybrid"};
  return kNames[static_cast<int>(mode)];
}

std::optional<RenderMode> RenderModeOf(std::string_view name) {
  return ValueNamed(name, {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid});
}

Result<void> CheckOpacity(const RadianceEncoding& encoding, RenderMode mode) {
  if (!Rebins(mode) || !encoding.HasOpacity()) return {};
  return UsageError(fmt::format(
      "{{mode {}}} cannot make frames with an alpha channel ({{background none}}, or "
      "lf_background in the calibration): use {{mode collect}}, or {{background black}}, "
      "which gives the same colours (for packages, give it to lfpreprocessor)",
      NameOf(mode)));
}

Result<void> CheckLenses(std::span<const RenderCamera> cameras, RenderMode mode) {
  if (!Rebins(mode)) return {};
  for (const RenderCamera& camera : cameras) {
    if (camera.hood.exists())
      return UsageError(fmt::format(
          "{{mode {}}} cannot render a lens with a hood (lens.hood_diameter in the path): use "
          "{{mode collect}}, or leave the hood out",
          NameOf(mode)));
    if (camera.transmission)
      return UsageError(
          fmt::format("{{mode {}}} cannot render a lens with a transmission (lens.transmission in "
                      "the path): use {{mode collect}}, or leave the transmission out",
                      NameOf(mode)));
    if (camera.surface)
      return UsageError(
          fmt::format("{{mode {}}} cannot render a focal surface (focus.surface in the path): use "
                      "{{mode collect}}, or remove 'focus' from the path",
                      NameOf(mode)));
  }
  return {};
}

Result<void> CheckShutter(bool has_shutter, RenderMode mode, bool is_guarded) {
  if (!has_shutter) return {};
  if (Rebins(mode))
    return UsageError(
        fmt::format("{{mode {}}} cannot render a path with a shutter, because rebinned rays are "
                    "queried for one "
                    "lens of each frame: use {{mode collect}}, or remove 'shutter' from the path",
                    NameOf(mode)));
  if (is_guarded)
    return UsageError(
        "the light field is densified, and frames of a path with a shutter cannot be guarded: add "
        "{guard off}, or remove 'shutter' from the path");
  return {};
}

}  // namespace lf
