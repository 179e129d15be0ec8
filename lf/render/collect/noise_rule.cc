// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/noise_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>
#include <vector>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

constexpr std::string_view kNoiseStart = "noise";
constexpr double kMostNoise = 1000;

}  // namespace

bool IsNoiseRule(const std::string& text) { return text.starts_with(kNoiseStart); }

Result<double> ParseNoiseRule(const std::string& text, const std::string& option) {
  constexpr std::string_view kWords = "noise<=";
  const std::optional<double> noise =
      text.starts_with(kWords) ? ParseNumber(std::string_view(text).substr(kWords.size()))
                               : std::nullopt;
  if (!noise || !(*noise > 0 && *noise <= kMostNoise))
    return UsageError(
        fmt::format("{} '{}': expected noise<=X with X above 0 and up to {}, such as noise<=0.002 "
                    "(linear light, white is 1)",
                    option, text, kMostNoise));
  return *noise;
}

std::string TextOfNoiseRule(double noise) { return fmt::format("noise<={}", noise); }

uint32_t NoiseDecisionAfter(uint32_t place) {
  constexpr uint32_t kFirst = 16;
  constexpr int kPerDoublingBits = 3;  // eight decisions from a power of two to the next
  if (place < kFirst) return kFirst;
  const int step_bits = std::bit_width(place) - 1 - kPerDoublingBits;
  const uint64_t next = ((uint64_t{place} >> step_bits) + 1) << step_bits;
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
