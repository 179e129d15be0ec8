// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/mosaic_share.h"

#include <array>
#include <cmath>
#include <vector>

#include "lf/collection/prefilter/mosaic_correction.h"
#include "lf/core/random.h"
#include "lf/render/collect/sampled_weights.h"

namespace lf {
namespace {

constexpr int kColumns = 8, kRows = 6;
static_assert(kColumns * kRows == kSampledElements);
constexpr uint64_t kSeed = 67;

// Returns `count` elements along an axis of the plate, a random one in each of as many parts, so
// that they have no regular distance, which might be a multiple of the mosaic's.
std::vector<int> RandomElements(int count, int size_px, uint64_t axis) {
  std::vector<int> elements;
  for (int i = 0; i < count; ++i) {
    const double at = (i + RandomUnit(kSeed, axis, static_cast<uint64_t>(i))) * size_px / count;
    elements.push_back(std::min(static_cast<int>(at), size_px - 1));
  }
  return elements;
}

}  // namespace

double MosaicShareOf(std::span<const FrameLens> lenses, std::span<const LfImageId> images) {
  const Intrinsics& plate = lenses.front().camera().pinhole.intrinsics;
  const SampledWeights sampled(lenses, RandomElements(kColumns, plate.width_px, 0),
                               RandomElements(kRows, plate.height_px, 1));
  std::array<std::array<double, 4>, kSampledElements> of_places = {};
  for (const LfImageId id : images)
    sampled.ForEach(id, [&](size_t element, double weight, const Vec2& position_px) {
      const auto odd = [](double px) { return std::fmod(std::floor(px), 2) == 0 ? 0U : 1U; };
      of_places[element][2 * odd(position_px.y()) + odd(position_px.x())] += weight;
    });
  double share = 0;
  int count = 0;
  for (const std::array<double, 4>& weights : of_places) {
    const double all = weights[0] + weights[1] + weights[2] + weights[3];
    if (!(all > 0)) continue;
    ++count;
    for (const double weight : weights) {
      const double excess = weight / all - 0.25;
      share += 4. / 3 * excess * excess;
    }
  }
  return count == 0 ? 1 : share / count;
}

int CorrectionFor(double share) {
  constexpr const auto& kShares = MosaicCorrection::kShares;
  int strength = 0;
  // The borders between strengths are the geometric means of their shares. That of no correction is
  // 1.
  double of_strength = 1;
  while (strength < kStrongestCorrection &&
         kShareFactor * share < std::sqrt(of_strength * kShares[static_cast<size_t>(strength)]))
    of_strength = kShares[static_cast<size_t>(strength++)];
  return strength;
}

}  // namespace lf
