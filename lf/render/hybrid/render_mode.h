// Modes of a render: the rays that its frames are made of (doc/rebinning.md).
#pragma once

#include <optional>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

//   kCollect  collected rays
//   kRebin    rays interpolated between rebinned ones
//   kHybrid   collected rays, completed by rebinned ones in the gaps of the lens
enum class RenderMode { kCollect, kRebin, kHybrid };

// Returns "collect", "rebin" or "hybrid".
const char* NameOf(RenderMode mode);
std::optional<RenderMode> RenderModeOf(std::string_view name);  // nullopt: another word

inline bool Collects(RenderMode mode) { return mode != RenderMode::kRebin; }
inline bool Rebins(RenderMode mode) { return mode != RenderMode::kCollect; }

// kUsage: LF images have opacities (RadianceEncoding::HasOpacity), which rebinned rays do not keep.
Result<void> CheckOpacity(const RadianceEncoding& encoding, RenderMode mode);

}  // namespace lf
