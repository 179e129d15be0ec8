#include "lf/render/hybrid/render_mode.h"

#include <fmt/format.h>

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
  return UsageError(
      fmt::format("--mode {}: rebinned rays keep colours alone, and no opacity for frames without "
                  "a background (--background none, lf_background): use --mode collect, or "
                  "--background black, which gives the same colours (packages have the background "
                  "that lfpreprocessor was given)",
                  NameOf(mode)));
}

}  // namespace lf
