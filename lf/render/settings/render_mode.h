// SPDX-License-Identifier: Apache-2.0
// The mode of a render says which rays its frames are made of (doc/rebinning.md).
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "lf/camera/render_camera.h"
#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

//   kCollect  collected rays
//   kRebin    rays that are interpolated between rebinned rays
//   kHybrid   collected rays, completed by interpolated rays in the gaps of the lens
enum class RenderMode { kCollect, kRebin, kHybrid };

// Returns "collect", "rebin" or "hybrid".
const char* NameOf(RenderMode mode);
std::optional<RenderMode> RenderModeOf(std::string_view name);  // nullopt if no mode has this name

inline bool Collects(RenderMode mode) { return mode != RenderMode::kRebin; }
inline bool Rebins(RenderMode mode) { return mode != RenderMode::kCollect; }

// Returns kUsage if the mode rebins and the LF images have opacity
// (RadianceEncoding::HasOpacity()), because rebinned rays do not keep it.
Result<void> CheckOpacity(const RadianceEncoding& encoding, RenderMode mode);

// Returns kUsage if the mode rebins and a camera has a hood or a transmission, because rebinned
// rays are queried at the same lens points for all elements, or a focal surface, because they are
// queried on one focus plane.
Result<void> CheckLenses(std::span<const RenderCamera> cameras, RenderMode mode);

// Returns kUsage if there is a shutter (CameraPath::shutter) but the mode rebins, or the frames are
// guarded: rebinned rays are queried for one lens, and a guarded plate compares the rays of one
// lens.
Result<void> CheckShutter(bool has_shutter, RenderMode mode, bool is_guarded);

}  // namespace lf
