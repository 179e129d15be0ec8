// SPDX-License-Identifier: Apache-2.0
// The mode of a render says which rays its frames are made of (doc/rebinning.md).
#pragma once

#include <optional>
#include <string_view>

namespace lf {

//   kCollect  collected rays
//   kRebin    rays that are kept in memory, and rays that are interpolated between them
//   kHybrid   collected rays, completed by interpolated rays in the gaps of the lens
enum class RenderMode { kCollect, kRebin, kHybrid };

// Returns "collect", "rebin" or "hybrid".
const char* NameOf(RenderMode mode);
std::optional<RenderMode> RenderModeOf(std::string_view name);  // nullopt if no mode has this name

inline bool Collects(RenderMode mode) { return mode != RenderMode::kRebin; }
inline bool Rebins(RenderMode mode) { return mode != RenderMode::kCollect; }

}  // namespace lf
