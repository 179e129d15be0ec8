// SPDX-License-Identifier: Apache-2.0
// Makes light fields whose LF images are loaded smaller than they were recorded.
#pragma once

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

inline constexpr int kMostReduction = 8;

// Makes the LF images of a light field smaller (WithLargerPixels() of camera/resolution.h), so that
// storage/load/open_store.h loads them reduced. A light field that is reduced already gets the
// larger of both divisors. kUsage: the divisor is not 1, 2, 4 or 8, or the light field is
// densified: its depths and trust belong to whole LF images.
Result<void> ReduceLightField(int divisor, LightField* light_field);

// Returns the light field as it was recorded: the opposite of ReduceLightField(), except for the
// footprint of its pixels.
LightField RecordedLightField(const LightField& light_field);

// Returns kUsage if the light field is reduced.
//   what  the work that needs whole LF images, to begin a sentence: "a packed store"
Result<void> CheckNotReduced(const LightField& light_field, const char* what);

}  // namespace lf
