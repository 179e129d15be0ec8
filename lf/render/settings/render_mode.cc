// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/render_mode.h"

#include "lf/core/value_named.h"

namespace lf {

const char* NameOf(RenderMode mode) {
  constexpr const char* kNames[] = {"collect", "rebin", "hybrid"};
  return kNames[static_cast<int>(mode)];
}

std::optional<RenderMode> RenderModeOf(std::string_view name) {
  return ValueNamed(name, {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid});
}

}  // namespace lf
