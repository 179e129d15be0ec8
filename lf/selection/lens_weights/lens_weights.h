// SPDX-License-Identifier: Apache-2.0
// The ways in which LF cameras can be weighted, each by the part of the lens that it stands for.
#pragma once

#include <optional>
#include <string_view>

namespace lf {

// How rays are weighted (doc/lens-integral.md).
//   kNone  all rays have equal weights, as in the thesis
//   kArea  by cells (CellShares()); needs a lens with an area: radius_w > 0
//   kHat   by hats (HatShares()), for very narrow lenses and pinholes
//   kAuto  by cells for wide lenses, by hats for narrow ones, and by a mixture in between
//          (AutoHatShare())
enum class LensWeights { kNone, kArea, kHat, kAuto };

// Returns "none", "area", "hat" or "auto".
const char* NameOf(LensWeights weights);
std::optional<LensWeights> LensWeightsOf(std::string_view name);  // nullopt for any other word

}  // namespace lf
