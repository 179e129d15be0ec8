// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/noise_rule.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

namespace lf {

uint32_t NoiseDecisionAfter(uint32_t rank) {
  constexpr uint32_t kFirst = 16;
  constexpr int kPerDoublingBits = 3;  // eight decisions from a power of two to the next
  if (rank < kFirst) return kFirst;
  const int step_bits = std::bit_width(rank) - 1 - kPerDoublingBits;
  const uint64_t next = ((uint64_t{rank} >> step_bits) + 1) << step_bits;
  return static_cast<uint32_t>(std::min<uint64_t>(next, UINT32_MAX));
}

double MeasureNoise(const SensorPlate& plate, const NoiseMoments& moments,
                    const ReachableElements& reachable) {
  std::vector<double> noise;
  for (size_t i = 0; i < moments.size(); ++i) {
    const PlateElement at = moments.ElementAt(i);
    if (!reachable.Holds(at.x, at.y)) continue;
    double largest = 0;
    for (int c = 0; c < SensorPlate::kChannels; ++c)
      largest = std::max(largest, StandardErrorOfMean(plate.At(at.x, at.y, c), moments.At(i, c)));
    noise.push_back(largest);
  }
  if (noise.empty()) return std::numeric_limits<double>::infinity();
  // Number of elements that may be noisier than the result.
  const auto above = static_cast<ptrdiff_t>(noise.size() / kNoisierOneIn);
  const auto at = noise.end() - 1 - above;
  std::nth_element(noise.begin(), at, noise.end());
  return *at;
}

}  // namespace lf
