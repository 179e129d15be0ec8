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
constexpr size_t kSpare = 15;  // values that CorrectLanes() may read and write beyond the end

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
        // 1
        {0, 0, 0, 0, 0, 0, 0, 0},
        {708, -214, 423, -261, 70, -191, 143, -103},
        {-44, -51, -44, 323, -82, -51, -82, -51},
        {0, 0, 0, 0, 0, 0, 0, 0},
        {393, -184, 393, -249, 105, -184, 105, -17},
    },
    {
        // 0.3
        {-632, 86, -632, -72, 100, 86, 100, -46},
        {1039, -236, -21, -343, 16, 21, 122, -50},
        {-179, -4, -179, 599, -160, -4, -160, -12},
        {-458, 98, -458, 88, 16, 98, 16, -42},
        {349, -125, 349, -245, 79, -125, 79, 3},
    },
    {
        // 0.1
        {-1344, 0, -1344, 14, 240, 0, 240, -140},
        {1302, -189, -253, -359, -54, 279, -15, 38},
        {52, 9, 52, 711, -204, 9, -204, 32},
        {-729, 124, -729, 93, 37, 124, 37, -63},
        {344, -55, 344, -66, 2, -55, 2, 31},
    },
    {
        // 0.03
        {-2014, -194, -2014, 252, 250, -194, 250, -176},
        {1277, 76, -125, -373, -114, 382, -109, 84},
        {552, -72, 552, 605, -141, -72, -141, 68},
        {-790, 89, -790, 2, 16, 89, 16, -37},
        {323, 21, 323, 179, -35, 21, -35, 22},
    },
    {
        // 0.01
        {-2073, -348, -2073, 404, 19, -348, 19, -170},
        {989, 416, 100, -365, -133, 319, -70, 104},
        {777, -207, 777, 451, 46, -207, 46, 58},
        {-659, 20, -659, -65, -58, 20, -58, -24},
        {252, 106, 252, 295, -6, 106, -6, 38},
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
        if (const int32_t* const pixel = at(dx, dy)) sum += weights[k] * (pixel[channel] - itself);
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
      sums_(3 * row_values_),
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

int32_t* MosaicCorrector::KeptRow(int y) {
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
  std::array<const int32_t*, 2 * kReach + 1> rows;
  for (int i = -kReach; i <= kReach; ++i)
    rows[static_cast<size_t>(i + kReach)] = KeptRow(y + i) - kReach * kPixelLanes;
  const std::array<int32_t*, 3> sums = {sums_.data(), sums_.data() + row_values_,
                                        sums_.data() + 2 * row_values_};
  AddRows(rows, row_values_ - kSpare, sums);
  constexpr size_t kFirst = kReach * kPixelLanes;
  CorrectLanes(lane_weights_[y % 2], {sums[0] + kFirst, sums[1] + kFirst, sums[2] + kFirst},
               static_cast<size_t>(pixels_.radiance.width()) * kPixelLanes, corrected_.data());
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
  const auto at = [&](int dx, int dy) -> const int32_t* {
    if (x + dx < 0 || x + dx >= pixels_.radiance.width() || y + dy < 0 ||
        y + dy >= pixels_.radiance.height())
      return nullptr;
    const int32_t* const pixel = KeptRow(y + dy) + (x + dx) * static_cast<ptrdiff_t>(kPixelLanes);
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
