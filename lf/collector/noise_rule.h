// The noise of a frame, and the rule "noise<=0.002" that stops or refuses the frame by it.
//
// The noise of a frame is that which kMostNoiseElements of its reachable elements stay below: of
// the elements that NoiseMoments measures and ReachableElements holds, the 90th percentile of the
// largest channel's standard error. Its unit is linear radiance where the light field's white, 1.0
// in an EXR frame, is 1, before white balance and colour matrix: the one scale that does not depend
// on brightness, and in which noise falls as 1 / sqrt(n) with the number n of LF images.
#pragma once

#include <cstdint>
#include <string>

#include "lf/collector/noise_moments.h"
#include "lf/collector/sample_rule.h"
#include "lf/core/result.h"
#include "lf/plate/sensor_plate.h"

namespace lf {

// Returns X of "noise<=X", above 0 and at most 1000. kUsage: the text is no such rule; the message
// names the option.
Result<double> ParseNoiseRule(const std::string& text, const std::string& option);
// Returns whether a text is meant as such a rule, right or wrong.
bool IsNoiseRule(const std::string& text);
// The rule as text, with as many digits as give the same X again.
std::string TextOfNoiseRule(double noise);

inline constexpr double kMostNoiseElements = 0.9;

// Returns the first place after `place` at which noise is asked for: 16, 18, ..., 32, 36, ..., 64,
// 72, ..., eight for each doubling. From one to the next a frame gets at most an eighth more LF
// images, however many it takes of a light field, so that it ends with no more than 6 % less noise
// than the last one that was too much; and a million LF images are cut into 130 parts, not more.
// Multiples of 64 are among them up to 1024, and of a larger power of two above.
uint32_t NoiseDecisionAfter(uint32_t place);

// Returns the noise of a frame in units of the rays' values v (RadianceEncoding::Scale() for each
// unit of radiance). Infinity where more than a tenth of the elements have fewer than two LF images
// in a channel, and where no element can be reached.
double MeasureNoise(const SensorPlate& plate, const NoiseMoments& moments,
                    const ReachableElements& reachable);

}  // namespace lf
