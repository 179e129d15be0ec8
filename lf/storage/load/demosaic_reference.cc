// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "lf/core/check.h"
#include "lf/storage/load/demosaic.h"
#include "lf/storage/load/demosaic_arithmetic.h"

namespace lf {
namespace {

// Weights of the 5 x 5 pixels around a pixel, in units of 1/16.
using Filter = std::array<std::array<int, 5>, 5>;

// Filters for a missing colour: `mean` for the pixels that recorded this colour, `laplacian` for
// the pixels of the colour that the centre recorded.
struct Estimate {
  Filter mean;
  Filter laplacian;  // already multiplied by the gain of the paper (demosaic.h)
};

constexpr Estimate kGreen = {{{{0, 0, 0, 0, 0},  //
                               {0, 0, 4, 0, 0},
                               {0, 4, 0, 4, 0},
                               {0, 0, 4, 0, 0},
                               {0, 0, 0, 0, 0}}},
                             {{{0, 0, -2, 0, 0},  //
                               {0, 0, 0, 0, 0},
                               {-2, 0, 8, 0, -2},
                               {0, 0, 0, 0, 0},
                               {0, 0, -2, 0, 0}}}};
// Estimate of R or B at a pixel of G, if its left and right neighbours recorded this colour.
constexpr Estimate kBeside = {{{{0, 0, 0, 0, 0},  //
                                {0, 0, 0, 0, 0},
                                {0, 8, 0, 8, 0},
                                {0, 0, 0, 0, 0},
                                {0, 0, 0, 0, 0}}},
                              {{{0, 0, 1, 0, 0},  //
                                {0, -2, 0, -2, 0},
                                {-2, 0, 10, 0, -2},
                                {0, -2, 0, -2, 0},
                                {0, 0, 1, 0, 0}}}};
// Estimate of R or B at a pixel of G, if the pixels above and below it recorded this colour.
constexpr Estimate kAbove = {{{{0, 0, 0, 0, 0},  //
                               {0, 0, 8, 0, 0},
                               {0, 0, 0, 0, 0},
                               {0, 0, 8, 0, 0},
                               {0, 0, 0, 0, 0}}},
                             {{{0, 0, -2, 0, 0},  //
                               {0, -2, 0, -2, 0},
                               {1, 0, 10, 0, 1},
                               {0, -2, 0, -2, 0},
                               {0, 0, -2, 0, 0}}}};
// Estimate of R at a pixel of B, and of B at a pixel of R.
constexpr Estimate kOpposite = {{{{0, 0, 0, 0, 0},  //
                                  {0, 4, 0, 4, 0},
                                  {0, 0, 0, 0, 0},
                                  {0, 4, 0, 4, 0},
                                  {0, 0, 0, 0, 0}}},
                                {{{0, 0, -3, 0, 0},  //
                                  {0, 0, 0, 0, 0},
                                  {-3, 0, 12, 0, -3},
                                  {0, 0, 0, 0, 0},
                                  {0, 0, -3, 0, 0}}}};

// One pixel (x, y) of a mosaic with its surroundings.
class Surroundings {
 public:
  Surroundings(const LfPixels& mosaic, int width, int height, int x, int y)
      : mosaic_(mosaic), width_(width), height_(height), x_(x), y_(y) {}

  int64_t Sum(const Filter& filter) const {
    int64_t sum = 0;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int weight = filter[static_cast<size_t>(dy) + 2][static_cast<size_t>(dx) + 2];
        // A pixel of weight 0 need not be in `mosaic`.
        if (weight != 0) sum += weight * int64_t{mosaic_.radiance.at(Column(dx), Row(dy))};
      }
    return sum;
  }

  bool AnyMasked() const {
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = std::abs(dy) - 2; dx <= 2 - std::abs(dy); ++dx)
        if (mosaic_.IsMasked(Column(dx), Row(dy))) return true;
    return false;
  }

  int RecordedAt(int dx, int dy) const {
    return BayerChannel(mosaic_.bayer, x_ + dx + 2, y_ + dy + 2);
  }

 private:
  // These functions return the column and row in mosaic_ of the pixel at the offset (dx, dy),
  // mirrored into the image.
  int Column(int dx) const { return Mirrored(x_ + dx, width_) - mosaic_.rect.x_begin; }
  int Row(int dy) const { return Mirrored(y_ + dy, height_) - mosaic_.rect.y_begin; }

  const LfPixels& mosaic_;
  int width_, height_, x_, y_;
};

uint16_t Colour(const Surroundings& at, const std::array<double, 3>& white_balance, int channel) {
  const int recorded = at.RecordedAt(0, 0);
  const auto by = [&](const Estimate& estimate) {
    constexpr int64_t kOne = 1 << (kWeightBits + kRatioBits);
    const int64_t sum = (at.Sum(estimate.mean) << kRatioBits) +
                        at.Sum(estimate.laplacian) * BalanceRatio(white_balance, recorded, channel);
    const int64_t clipped = std::clamp<int64_t>(sum + kOne / 2, 0, 65535 * kOne);
    return static_cast<uint16_t>(clipped / kOne);
  };
  if (channel == recorded) {
    Filter itself{};
    itself[2][2] = 1;
    return static_cast<uint16_t>(at.Sum(itself));
  }
  if (channel == 1) return by(kGreen);
  if (recorded != 1) return by(kOpposite);
  return by(at.RecordedAt(1, 0) == channel ? kBeside : kAbove);
}

}  // namespace

void DemosaicReference(const LfPixels& mosaic, int image_width_px, int image_height_px,
                       const std::array<double, 3>& white_balance, const PixelRect& rect,
                       LfPixels* rgb) {
  *rgb = LfPixels(rect, BayerPattern::kNone);
  rgb->recorded = mosaic.bayer;
  for (int row = 0; row < rect.height(); ++row)
    for (int column = 0; column < rect.width(); ++column) {
      const Surroundings at(mosaic, image_width_px, image_height_px, rect.x_begin + column,
                            rect.y_begin + row);
      for (int channel = 0; channel < 3; ++channel)
        rgb->radiance.at(column, row, channel) = Colour(at, white_balance, channel);
      if (at.AnyMasked()) rgb->Mask(column, row);
    }
}

}  // namespace lf
