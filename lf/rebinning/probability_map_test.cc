// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/probability_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

LfPixels Noise(const PixelRect& rect, BayerPattern bayer, uint64_t seed) {
  LfPixels pixels(rect, bayer);
  RandomSequence random(seed);
  const int lanes = pixels.radiance.channels();
  for (size_t i = 0; i < pixels.radiance.pixels().size(); ++i)
    if (static_cast<int>(i % lanes) != LfPixels::kRayLane)
      pixels.radiance.pixels()[i] = static_cast<uint16_t>(random.Uniform(0, 65536));
  return pixels;
}

Image<uint16_t> ProbabilitiesOf(const LfPixels& pixels, const std::vector<uint16_t>& table,
                                const ProbabilityOptions& options) {
  Image<uint16_t> p;
  ProbabilityMap(pixels, pixels.rect, table, options, &p);
  return p;
}

void ExpectSamePixels(const Image<uint16_t>& a, const Image<uint16_t>& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  EXPECT_EQ(a.pixels(), b.pixels());
}

TEST(ProbabilityMap, FastIsTheReference) {
  const std::vector<uint16_t> table = StoredValueTable({});
  const PixelRect rects[] = {
      {0, 0, 1, 1}, {3, 5, 4, 90}, {0, 0, 133, 2}, {7, 3, 90, 71}, {10, 20, 41, 53}};
  uint64_t seed = 0;
  for (const PixelRect& rect : rects)
    for (const BayerPattern bayer : {BayerPattern::kNone, BayerPattern::kRggb, BayerPattern::kGbrg})
      for (const double sigma : {0.0, 0.5, 1.0, 3.7})
        for (const double second : {0.0, 1.5}) {
          LfPixels pixels = Noise(rect, bayer, ++seed);
          pixels.Mask(0, 0);
          const ProbabilityOptions options{sigma, 0.3, 0.02, 0.1, second};
          Image<uint16_t> judge;
          ProbabilityMapReference(pixels, rect, table, options, &judge);
          ExpectSamePixels(ProbabilitiesOf(pixels, table, options), judge);
          // The fast map equals the reference also for two parts: one in the lower middle, and the
          // leftmost column.
          const int x = rect.width() / 3, y = rect.height() / 2;
          for (const PixelRect& part :
               {PixelRect{rect.x_begin + x, rect.y_begin + y, rect.x_end - x, rect.y_end},
                PixelRect{rect.x_begin, rect.y_begin, rect.x_begin + 1, rect.y_end}}) {
            Image<uint16_t> p;
            ProbabilityMap(pixels, part, table, options, &p);
            ProbabilityMapReference(pixels, part, table, options, &judge);
            ExpectSamePixels(p, judge);
          }
        }
}

TEST(ProbabilityMap, AnEdgeIsLikelyAndFlatIsXi) {
  RadianceEncoding linear;
  linear.transfer = Transfer::kLinear;
  const std::vector<uint16_t> table = StoredValueTable(linear);
  LfPixels pixels({0, 0, 40, 20}, BayerPattern::kNone);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x)
      for (int c = 0; c < 3; ++c) pixels.radiance.at(x, y, c) = x < 20 ? 10000 : 40000;
  const Image<uint16_t> p = ProbabilitiesOf(pixels, table, {1, 4, 0, 0.25, 0});
  EXPECT_EQ(p.at(3, 10), std::lround(0.25 * 65535));
  // Beside an edge of height h, the Laplacian of the step smoothed with sigma = 1 is h times the
  // difference of the Gaussian at 0 and at 1 pixel.
  const double step = 30000 / 65535.0;
  const auto gaussian = [](double x) { return std::exp(-x * x / 2) / std::sqrt(2 * kPi); };
  const double expected = step * (gaussian(0) - gaussian(1)) * 4 + 0.25;
  EXPECT_NEAR(p.at(20, 10) / 65535.0, expected, 0.01);
  EXPECT_EQ(p.at(19, 10), p.at(20, 10));
  // A pixel where |LoG| is below beta is never kept.
  EXPECT_EQ(ProbabilitiesOf(pixels, table, {1, 4, 0.01, 0.25, 0}).at(3, 10), 0);
}

// Thesis Eq. 2.15 to 2.17 and 4.4 in real numbers: a Gaussian in two dimensions, the Laplacian of
// the smoothed image, and min(1, |LoG| alpha + xi) where |LoG| is at least beta. The plane
// continues beyond its border with its outermost values.
class RealProbabilities {
 public:
  RealProbabilities(const Image<double>& grey, double sigma)
      : smooth_(grey.width(), grey.height()) {
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    for (int y = 0; y < grey.height(); ++y)
      for (int x = 0; x < grey.width(); ++x) {
        double sum = 0, weights = 0;
        for (int v = -radius; v <= radius; ++v)
          for (int u = -radius; u <= radius; ++u) {
            const double weight =
                std::exp(-(u * u + v * v) / (2 * sigma * sigma)) / (2 * kPi * sigma * sigma);
            sum += weight * grey.at(std::clamp(x + u, 0, grey.width() - 1),
                                    std::clamp(y + v, 0, grey.height() - 1));
            weights += weight;
          }
        smooth_.at(x, y) = sum / weights;
      }
  }
  double At(int x, int y, const ProbabilityOptions& options) const {
    const auto at = [this](int u, int v) {
      return smooth_.at(std::clamp(u, 0, smooth_.width() - 1),
                        std::clamp(v, 0, smooth_.height() - 1));
    };
    const double across = at(x - 1, y) - 2 * at(x, y) + at(x + 1, y);
    const double down = at(x, y - 1) - 2 * at(x, y) + at(x, y + 1);
    const double change = std::abs(across + down);
    return change >= options.beta ? std::min(1.0, change * options.alpha + options.xi) : 0;
  }

 private:
  Image<double> smooth_;
};

TEST(ProbabilityMap, IsTheThesissEquationsInRealNumbers) {
  RadianceEncoding linear;
  linear.transfer = Transfer::kLinear;
  const std::vector<uint16_t> table = StoredValueTable(linear);
  const LfPixels pixels = Noise({0, 0, 48, 40}, BayerPattern::kNone, 11);
  Image<double> grey(48, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x)
      grey.at(x, y) = (pixels.radiance.at(x, y, 0) + 2.0 * pixels.radiance.at(x, y, 1) +
                       pixels.radiance.at(x, y, 2)) /
                      (4 * 65535.0);
  for (const double sigma : {0.6, 1.0, 2.0}) {
    const RealProbabilities real(grey, sigma);
    const ProbabilityOptions options{sigma, sigma > 1 ? 20.0 : 2.0, 0.02, 0.1, 0};
    const Image<uint16_t> p = ProbabilitiesOf(pixels, table, options);
    int likely = 0, unlikely = 0, out = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 48; ++x) {
        const double expected = real.At(x, y, options);
        // In integers, a value near beta may be on the other side of it.
        ProbabilityOptions lower = options, higher = options;
        lower.beta -= 0.002, higher.beta += 0.002;
        if (real.At(x, y, lower) != real.At(x, y, higher)) continue;
        EXPECT_NEAR(p.at(x, y) / 65535.0, expected, 0.002 * options.alpha) << sigma;
        likely += expected == 1, unlikely += expected == 0, ++out;
      }
    EXPECT_GT(out, 1700);
    EXPECT_GT(unlikely, 20);
    if (sigma == 0.6) {
      EXPECT_GT(likely, 20);
    }
  }
}

// The rectangle that was read must not influence which rays are kept, except near its borders.
TEST(ProbabilityMap, APartIsThePartOfTheWhole) {
  const std::vector<uint16_t> table = StoredValueTable({});
  for (const BayerPattern bayer : {BayerPattern::kNone, BayerPattern::kBggr}) {
    const LfPixels whole = Noise({0, 0, 64, 64}, bayer, 5);
    const PixelRect rect{13, 10, 50, 41};
    LfPixels part(rect, bayer);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 0; c < part.radiance.channels(); ++c)
          part.radiance.at(x, y, c) = whole.radiance.at(x + rect.x_begin, y + rect.y_begin, c);
    const ProbabilityOptions options{1, 0.3, 0, 0.05, 0};
    const Image<uint16_t> of_whole = ProbabilitiesOf(whole, table, options);
    const Image<uint16_t> of_part = ProbabilitiesOf(part, table, options);
    const int around = PixelsAround(options, bayer != BayerPattern::kNone);
    EXPECT_LT(around, 10);
    for (int y = around; y < rect.height() - around; ++y)
      for (int x = around; x < rect.width() - around; ++x)
        ASSERT_EQ(of_part.at(x, y), of_whole.at(x + rect.x_begin, y + rect.y_begin));
  }
}

TEST(ProbabilityMap, StoredValuesAreThoseOfTheFile) {
  for (const Transfer transfer : {Transfer::kSrgb, Transfer::kLinear, Transfer::kResponse}) {
    RadianceEncoding encoding;
    encoding.transfer = transfer;
    encoding.response = {0, 0.05, 0.3, 1};
    encoding.pedestal = 1024;
    encoding.white_level = 200;
    encoding.black_level = 10;
    const std::vector<uint16_t> linear = RadianceTable(encoding, 8, 1);
    const std::vector<uint16_t> stored = StoredValueTable(encoding);
    for (int value = 10; value <= 200; ++value)
      EXPECT_NEAR(stored[linear[value]], (value - 10) / 190.0 * 65535, 20) << value;
  }
}

}  // namespace
}  // namespace lf
