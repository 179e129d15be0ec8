// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/prefilter/mosaic_correction.h"

#include <algorithm>
#include <initializer_list>

#include "lf/collection/prefilter/mosaic_correction_rows.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int kReach = MosaicCorrection::kReach_px;
constexpr size_t kRing = 2 * kReach + 1;
constexpr size_t kPixelLanes = LfPixels::kRgbLanes;
constexpr size_t kSpare = 15;  // values that AddRows() and CorrectLanes() may touch beyond the end
// Rows are corrected in blocks whose sums stay in the first level cache. The number is even, so
// that all blocks begin at the same place in the pattern.
constexpr size_t kBlock_px = 128;
constexpr size_t kSumValues = (kBlock_px + 2 * kReach) * kPixelLanes + kSpare;

// The weights at the places of a pixel in the pattern of the mosaic, as seen from a colour.
struct PlaceWeights {
  MosaicCorrection::Weights recorded;  // R or B, where it was recorded
  MosaicCorrection::Weights beside;    // R or B, where the pixels to both sides recorded it
  MosaicCorrection::Weights opposite;  // R at B, B at R
  MosaicCorrection::Weights green;     // G, where it was recorded
  MosaicCorrection::Weights not_green;
};

// Made by bench/mosaic_correction.cc, for the shares of MosaicCorrection::kShares.
constexpr PlaceWeights kWeights[kStrongestCorrection] = {
    {
        // 0.3
        {-546, 95, -546, -71, 58, 95, 58, -36},
        {853, -168, 29, -287, 21, 21, 123, -50},
        {-145, -67, -145, 478, -92, -67, -92, -40},
        {-498, 105, -498, 106, 21, 105, 21, -38},
        {301, -182, 301, -293, 93, -182, 93, 10},
    },
    {
        // 0.1
        {-1140, 9, -1140, -21, 169, 9, 169, -133},
        {1170, -147, -227, -326, -35, 260, 8, 31},
        {-14, -33, -14, 677, -154, -33, -154, 14},
        {-795, 142, -795, 108, 41, 142, 41, -52},
        {296, -108, 296, -52, 6, -108, 6, 32},
    },
    {
        // 0.03
        {-1631, -255, -1631, 142, 200, -255, 200, -221},
        {1249, 43, -196, -354, -76, 413, -89, 89},
        {304, -29, 304, 676, -134, -29, -134, 81},
        {-853, 107, -853, 13, 15, 107, 15, -25},
        {274, -9, 274, 229, -37, -9, -37, 19},
    },
    {
        // 0.01
        {-1565, -503, -1565, 248, 14, -503, 14, -279},
        {1023, 330, -52, -348, -110, 398, -34, 128},
        {399, -64, 399, 585, -4, -64, -4, 107},
        {-698, 33, -698, -48, -69, 33, -69, -16},
        {207, 101, 207, 336, -11, 101, -11, 40},
    },
};

// Exchanges the columns and rows of groups: weights for pixels to both sides that recorded a colour
// become those for pixels above and below.
MosaicCorrection::Weights Transposed(const MosaicCorrection::Weights& weights) {
  MosaicCorrection::Weights result = {};
  for (size_t k = 0; k < weights.size(); ++k)
    for (size_t j = 0; j < weights.size(); ++j)
      if (MosaicCorrection::kGroups[j][0] == MosaicCorrection::kGroups[k][1] &&
          MosaicCorrection::kGroups[j][1] == MosaicCorrection::kGroups[k][0])
        result[k] = weights[j];
  return result;
}

// Returns the corrected value of one colour of a pixel.
//   at  at(dx, dy) returns the lanes of the pixel at this distance, or null if it does not count
template <class At>
uint16_t Corrected(const MosaicCorrection::Weights& weights, const At& at, int channel) {
  const int32_t itself = at(0, 0)[channel];
  int32_t sum = 1 << (MosaicCorrection::kBits - 1);
  for (size_t k = 0; k < weights.size(); ++k) {
    const int columns = MosaicCorrection::kGroups[k][0], rows = MosaicCorrection::kGroups[k][1];
    for (int dy = -rows; dy <= rows; dy += std::max(1, 2 * rows))
      for (int dx = -columns; dx <= columns; dx += std::max(1, 2 * columns))
        if (const uint16_t* const pixel = at(dx, dy)) sum += weights[k] * (pixel[channel] - itself);
  }
  return static_cast<uint16_t>(std::clamp(itself + (sum >> MosaicCorrection::kBits), 0, 65535));
}

}  // namespace

MosaicCorrection::Weights CorrectionWeights(int strength, BayerPattern recorded, int x, int y,
                                            int channel) {
  LF_DCHECK(strength >= 1 && strength <= kStrongestCorrection && recorded != BayerPattern::kNone);
  const PlaceWeights& of = kWeights[strength - 1];
  const int own = BayerChannel(recorded, x, y);
  if (channel == 1) return own == 1 ? of.green : of.not_green;
  if (own == channel) return of.recorded;
  if (own != 1) return of.opposite;
  return BayerChannel(recorded, x + 1, y) == channel ? of.beside : Transposed(of.beside);
}

MosaicCorrector::MosaicCorrector(int strength, const LfPixels& pixels)
    : pixels_(pixels),
      row_values_((static_cast<size_t>(pixels.radiance.width()) + 2 * kReach) * kPixelLanes +
                  kSpare),
      rows_(kRing * row_values_),
      sums_(3 * kSumValues),
      corrected_(row_values_) {
  LF_CHECK(strength >= 1 && strength <= kStrongestCorrection);
  LF_CHECK(pixels.bayer == BayerPattern::kNone && pixels.recorded != BayerPattern::kNone);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x)
      for (int c = 0; c < 3; ++c)
        weights_[y][x][c] = CorrectionWeights(strength, pixels.recorded, pixels.rect.x_begin + x,
                                              pixels.rect.y_begin + y, c);
  for (int y = 0; y < 2; ++y)
    for (size_t k = 0; k < MosaicCorrection::kGroupCount; ++k)
      for (size_t i = 0; i < lane_weights_[y][k].size(); ++i) {
        const size_t lane = i % kPixelLanes;
        lane_weights_[y][k][i] =
            lane == LfPixels::kRayLane ? 0 : weights_[y][i / kPixelLanes % 2][lane][k];
      }
}

uint16_t* MosaicCorrector::KeptRow(int y) {
  return rows_.data() + static_cast<size_t>(y) % kRing * row_values_ + kReach * kPixelLanes;
}

const uint16_t* MosaicCorrector::Row(int y) {
  const int width = pixels_.radiance.width(), height = pixels_.radiance.height();
  for (; kept_ <= std::min(y + kReach, height - 1); ++kept_)
    std::copy_n(pixels_.radiance.row(kept_), static_cast<size_t>(width) * kPixelLanes,
                KeptRow(kept_));
  const bool has_rows = y >= kReach && y + kReach < height;
  if (has_rows) CorrectWholeRow(y);
  if (!has_rows || pixels_.any_masked) {
    for (int x = 0; x < width; ++x)
      if (!has_rows || x < kReach || x + kReach >= width || AnyMaskedAround(x, y))
        CorrectPixel(x, y);
  } else {
    for (int x = 0; x < std::min(kReach, width); ++x) CorrectPixel(x, y);
    for (int x = std::max(kReach, width - kReach); x < width; ++x) CorrectPixel(x, y);
  }
  return corrected_.data();
}

void MosaicCorrector::CorrectWholeRow(int y) {
  const std::array<int32_t*, 3> sums = {sums_.data(), sums_.data() + kSumValues,
                                        sums_.data() + 2 * kSumValues};
  constexpr size_t kFirst = kReach * kPixelLanes;
  const auto width = static_cast<size_t>(pixels_.radiance.width());
  for (size_t x = 0; x < width; x += kBlock_px) {
    const size_t count = std::min(kBlock_px, width - x) * kPixelLanes;
    std::array<const uint16_t*, 2 * kReach + 1> rows;
    for (int i = -kReach; i <= kReach; ++i)
      rows[static_cast<size_t>(i + kReach)] = KeptRow(y + i) + x * kPixelLanes - kFirst;
    AddRows(rows, count + 2 * kFirst, sums);
    CorrectLanes(lane_weights_[y % 2], {sums[0] + kFirst, sums[1] + kFirst, sums[2] + kFirst},
                 count, corrected_.data() + x * kPixelLanes);
  }
}

bool MosaicCorrector::AnyMaskedAround(int x, int y) {
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx)
      if (KeptRow(y + dy)[(x + dx) * static_cast<ptrdiff_t>(kPixelLanes) + LfPixels::kRayLane] == 0)
        return true;
  return false;
}

// Corrects a pixel some of whose surroundings may be missing.
void MosaicCorrector::CorrectPixel(int x, int y) {
  const auto at = [&](int dx, int dy) -> const uint16_t* {
    if (x + dx < 0 || x + dx >= pixels_.radiance.width() || y + dy < 0 ||
        y + dy >= pixels_.radiance.height())
      return nullptr;
    const uint16_t* const pixel = KeptRow(y + dy) + (x + dx) * static_cast<ptrdiff_t>(kPixelLanes);
    return pixel[LfPixels::kRayLane] == 0 ? nullptr : pixel;
  };
  uint16_t* const out = corrected_.data() + static_cast<size_t>(x) * kPixelLanes;
  if (at(0, 0) == nullptr) {
    std::fill_n(out, kPixelLanes, uint16_t{0});
    return;
  }
  for (int c = 0; c < 3; ++c) out[c] = Corrected(weights_[y % 2][x % 2][c], at, c);
  out[LfPixels::kRayLane] = 1;
}

}  // namespace lf
