// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/raw_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

namespace lf {
namespace {

constexpr double kLargestFactor = 1000;

// Returns the white balance as shot; none if a factor is not in (0, kLargestFactor]. LibRaw has
// factors of R, G, B and a second green, which is not used.
std::optional<std::array<double, 3>> WhiteBalanceOf(const libraw_colordata_t& colour) {
  const auto& factors = colour.cam_mul;
  const std::array<double, 3> balance = {static_cast<double>(factors[0]) / factors[1], 1,
                                         static_cast<double>(factors[2]) / factors[1]};
  for (const double factor : balance)
    if (!(factor > 0 && factor <= kLargestFactor)) return std::nullopt;
  return balance;
}

// Returns the colour matrix; none if LibRaw knows none (it then gives the identity) or an entry
// exceeds kLargestFactor. Each row of LibRaw's matrix has entries for R, G, B and a second green,
// which is not used.
std::optional<Mat3> LinearSrgbFromCamera(const libraw_colordata_t& colour) {
  Mat3 matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) matrix(row, column) = colour.rgb_cam[row][column];
  if (!(matrix.cwiseAbs().maxCoeff() <= kLargestFactor) || matrix == Mat3::Identity())
    return std::nullopt;
  return matrix;
}

// Returns the mean black level. LibRaw's levels add up: one for all pixels, one for each colour,
// and a pattern of rows x columns levels.
template <class T>
double MeanBlack(double common, const T* levels, unsigned rows, unsigned columns) {
  double mean = common + std::accumulate(levels, levels + 4, 0.0) / 4;
  const size_t count = size_t{rows} * columns;
  if (count > 0 && count <= LIBRAW_CBLACK_SIZE - 7)
    mean += std::accumulate(levels + 6, levels + 6 + count, 0.0) / static_cast<double>(count);
  return mean;
}

double DngBlack(const libraw_dng_levels_t& levels) {
  return MeanBlack(levels.dng_fblack, levels.dng_fcblack,
                   static_cast<unsigned>(levels.dng_cblack[4]),
                   static_cast<unsigned>(levels.dng_cblack[5]));
}

}  // namespace

bool RepeatsEveryTwo(LibRaw& raw) {
  for (int y = 2; y < 8; ++y)
    for (int x = 0; x < 2; ++x) {
      // A second green may have its own colour number.
      const char here = raw.imgdata.idata.cdesc[raw.COLOR(y, x)];
      if (here != raw.imgdata.idata.cdesc[raw.COLOR(y % 2, x)]) return false;
    }
  return true;
}

BayerPattern PatternAt(LibRaw& raw, int x, int y) {
  // LibRaw's COLOR() counts from the corner of the image inside the margins, but x and y from the
  // corner of the sensor. Modulo 2, adding a margin is the same as subtracting it.
  const libraw_image_sizes_t& sizes = raw.imgdata.sizes;
  const int column = (x + sizes.left_margin) % 2, row = (y + sizes.top_margin) % 2;
  for (const BayerPattern pattern :
       {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg, BayerPattern::kGbrg}) {
    bool same = true;
    for (int i = 0; i < 4; ++i) {
      const char colour = raw.imgdata.idata.cdesc[raw.COLOR(row + i / 2, column + i % 2)];
      same &= std::string_view("RGB")[BayerChannel(pattern, i % 2, i / 2)] == colour;
    }
    if (same) return pattern;
  }
  return BayerPattern::kNone;
}

RawFacts FactsOf(const libraw_data_t& raw, bool is_unpacked) {
  const auto is_level = [](double x) { return x >= 0 && x <= 65535; };
  const libraw_colordata_t& colour = raw.color;
  RawFacts facts;
  facts.white_balance = WhiteBalanceOf(colour);
  facts.linear_srgb_from_camera = LinearSrgbFromCamera(colour);
  const bool is_dng = raw.idata.dng_version != 0;
  const double black =
      is_dng ? DngBlack(colour.dng_levels)
             : MeanBlack(colour.black, colour.cblack, colour.cblack[4], colour.cblack[5]);
  if ((is_dng || is_unpacked) && is_level(black)) facts.black_level = black;
  const double white = is_dng ? colour.dng_levels.dng_whitelevel[0] : colour.maximum;
  if (is_level(white) && white > facts.black_level.value_or(0)) facts.white_level = white;
  return facts;
}

int OrientationOf(int flip) {
  constexpr std::array<int, 8> kOrientations = {1, 2, 4, 3, 5, 8, 6, 7};
  return flip >= 0 && flip < 8 ? kOrientations[static_cast<size_t>(flip)] : 1;
}

}  // namespace lf
