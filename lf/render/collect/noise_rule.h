// SPDX-License-Identifier: Apache-2.0
// The noise of a frame, and the rule "noise<=X" (such as "noise<=0.002"): --stop-when stops a frame
// by it, --require fails if a frame breaks it.
//
// The noise of a frame is a percentile (the 90th, kNoisierOneIn) over those elements that
// NoiseMoments measures and that are reachable (ReachableElements). Each element contributes the
// standard error of its noisiest channel. The unit is linear radiance before white balance and
// colour matrix; 1 is the light field's white (1.0 in an EXR frame). Linear radiance is used,
// because noise in it falls as 1 / sqrt(n) with the number n of LF images, whatever the brightness.
//
// It is the error of LF images that are drawn at random. With ImageOrder::kSpread it is a bound:
// the frame is nearer to the frame of all LF images, usually by a factor of about two
// (doc/checkpoints.md, "Measured noise"). The bound is not calibrated, because the factor depends
// on the picture.
#pragma once

#include <cstdint>

#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/collect/sample_rule.h"

namespace lf {

// One in this many of the measured reachable elements, rounded down, may be noisier than the frame.
inline constexpr size_t kNoisierOneIn = 10;

// Returns the first rank of the order of LF images, after `rank`, at which noise is measured: 16,
// 18, ..., 32, 36, ..., 64, 72, ...: eight ranks for each doubling. From one of these ranks to
// the next, a frame gets about an eighth more LF images at most, whatever share of the light field
// it takes. When it stops, it therefore has about 6 % less noise, at most, than at the previous
// rank, where the noise was still too high. For a million LF images, noise is measured at most 130
// times. Up to 1024, the ranks include all multiples of 64; above, all multiples of a larger power
// of two.
uint32_t NoiseDecisionAfter(uint32_t rank);

// Returns the noise of a frame in units of the rays' values v: divide by RadianceEncoding::Scale()
// to get radiance. Infinity if more than a tenth of the measured reachable elements have fewer than
// two LF images in a channel, or if no measured element is reachable.
double MeasureNoise(const SensorPlate& plate, const NoiseMoments& moments,
                    const ReachableElements& reachable);

}  // namespace lf
