// The noise of a frame, and the rule "noise<=0.002" that stops or refuses the frame by it.
//
// The noise of a frame is the value that kMostNoiseElements of its reachable elements stay below:
// the 90th percentile of the standard error in each element's noisiest channel, over the elements
// that NoiseMoments measures and ReachableElements holds. Its unit is linear radiance, before white
// balance and colour matrix, where the light field's white, 1.0 in an EXR frame, is 1. This is the
// one scale that does not depend on brightness, and in which noise falls as 1 / sqrt(n) with the
// number n of LF images.
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/collect/sample_rule.h"

namespace lf {

// Returns X of "noise<=X", above 0 and at most 1000. kUsage if the text is no such rule; the
// message names the option.
Result<double> ParseNoiseRule(const std::string& text, const std::string& option);
// True if a text is meant as such a rule, right or wrong.
bool IsNoiseRule(const std::string& text);
// Returns the rule as text, with as many digits as give the same X again.
std::string TextOfNoiseRule(double noise);

inline constexpr double kMostNoiseElements = 0.9;

// Returns the first place after `place` at which noise is asked for: 16, 18, ..., 32, 36, ..., 64,
// 72, ..., eight for each doubling. From one to the next, a frame gets at most an eighth more LF
// images, whatever share of the light field it takes. It therefore stops with at most 6 % less
// noise than at the last place where there was too much, and a million LF images are cut into at
// most 130 parts. These places contain the multiples of 64 up to 1024, and of a larger power of two
// above.
uint32_t NoiseDecisionAfter(uint32_t place);

// Returns the noise of a frame in units of the rays' values v (RadianceEncoding::Scale() for each
// unit of radiance). Infinity if more than a tenth of the elements have fewer than two LF images in
// a channel, or if no element can be reached.
double MeasureNoise(const SensorPlate& plate, const NoiseMoments& moments,
                    const ReachableElements& reachable);

}  // namespace lf
