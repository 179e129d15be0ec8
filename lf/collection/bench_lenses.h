// SPDX-License-Identifier: Apache-2.0
// Lens distortions of the benchmarks of ray collection. Internal to collection.
#pragma once

#include "lf/camera/distortion.h"

namespace lf {

inline constexpr Distortion kPhoneLens{DistortionModel::kRadialTangential, {0.035}};
inline constexpr Distortion kBarrelLens{DistortionModel::kRadialTangential,
                                        {-0.25, 0.07, 0.002, -0.003}};
inline constexpr Distortion kFisheyeLens{DistortionModel::kFisheye, {-0.02, 0.004, -0.002, 3e-4}};

}  // namespace lf
