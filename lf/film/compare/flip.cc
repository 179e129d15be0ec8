// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/film/compare/separable_filter.h"

namespace lf {
namespace {

// Numbers of the paper: exponents of colours and features, and where the range of errors bends.
constexpr double kColourExponent = 0.7, kFeatureExponent = 0.5, kBendAt = 0.4, kBendTo = 0.95;
// Width of the human eye's detector of edges, in degrees.
constexpr double kDetectorWidth = 0.082;

// Contrast sensitivity of one channel: a1 sqrt(pi / b1) exp(-pi^2 z^2 / b1) + the same of a2 and
// b2, where z is the distance in degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic = {1, 0.0047, 0, 1e-5}, kRedGreen = {1, 0.0053, 0, 1e-5},
                      kBlueYellow = {34.1, 0.04, 13.5, 0.025};

// XYZ of linear light in the primaries of sRGB (IEC 61966-2-1, as FLIP's authors round it).
const Mat3& XyzFromRgb() {
  static const Mat3 matrix =
      (Mat3() << 10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,
       2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897, 1425312.0 / 73733382,
       8788810.0 / 73733382, 70074185.0 / 73733382)
          .finished();
  return matrix;
}
Vec3 White() { return XyzFromRgb() * Vec3::Ones(); }

// Opponent colours: lightness, red against green, blue against yellow.
Vec3 OpponentOf(const Vec3& rgb) {
  const Vec3 v = (XyzFromRgb() * rgb).cwiseQuotient(White());
  return {116 * v.y() - 16, 500 * (v.x() - v.y()), 200 * (v.y() - v.z())};
}
Vec3 RgbFromOpponent(const Vec3& opponent) {
  static const Mat3 rgb_from_xyz = XyzFromRgb().inverse();
  const double y = (opponent.x() + 16) / 116;
  const Vec3 v(y + opponent.y() / 500, y, y - opponent.z() / 200);
  return rgb_from_xyz * v.cwiseProduct(White());
}

// CIELAB, whose colours count less the darker they are (Hunt's effect).
Vec3 HuntLabOf(const Vec3& rgb) {
  constexpr double kDelta = 6.0 / 29;
  Vec3 v = (XyzFromRgb() * rgb).cwiseQuotient(White());
  for (double& t : v)
    t = t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  const double lightness = 116 * v.y() - 16;
  return {lightness, 0.01 * lightness * 500 * (v.x() - v.y()),
          0.01 * lightness * 200 * (v.y() - v.z())};
}

// Distance of two colours that holds for large differences as well (HyAB).
double HybridDistance(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return std::abs(d.x()) + std::hypot(d.y(), d.z());
}

// Filters a channel by the contrast sensitivity of the eye: a weighted sum of two Gaussians, each
// of which is a product of a column and a row.
Image<float> FilterBySensitivity(const Image<float>& channel, const Sensitivity& s,
                                 double pixels_per_degree, ThreadPool& pool) {
  // The widest channel decides the radius of all.
  const int radius = static_cast<int>(
      std::ceil(3 * std::sqrt(kBlueYellow.b1 / (2 * M_PI * M_PI)) * pixels_per_degree));
  struct Part {
    std::vector<double> weights;
    double share;
  };
  std::vector<Part> parts;
  double sum = 0;
  for (const auto& [a, b] : {std::pair(s.a1, s.b1), std::pair(s.a2, s.b2)}) {
    if (a == 0) continue;
    const double sigma = std::sqrt(b / 2) / M_PI * pixels_per_degree;
    double total = 0;
    for (int i = -radius; i <= radius; ++i) total += std::exp(-0.5 * i * i / (sigma * sigma));
    parts.push_back({GaussianWeights(sigma, radius), a * std::sqrt(M_PI / b) * total * total});
    sum += parts.back().share;
  }
  Image<float> result(channel.width(), channel.height());
  for (const Part& part : parts) {
    const Image<float> filtered = FilterSeparably(channel, part.weights, part.weights, pool);
    const auto share = static_cast<float>(part.share / sum);
    for (size_t i = 0; i < result.pixels().size(); ++i)
      result.pixels()[i] += share * filtered.pixels()[i];
  }
  return result;
}

// Divides the positive weights by their sum, and the negative ones by minus theirs.
void NormalizeBySign(std::vector<double>* weights) {
  double positive = 0, negative = 0;
  for (const double weight : *weights) (weight > 0 ? positive : negative) += weight;
  for (double& weight : *weights) weight /= weight > 0 ? positive : -negative;
}

// Strength of edges or points in every direction, of a picture of lightness.
Image<float> FeatureStrength(const Image<float>& lightness, bool points, double pixels_per_degree,
                             ThreadPool& pool) {
  const double sigma = 0.5 * kDetectorWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const std::vector<double> smooth = GaussianWeights(sigma, radius);
  std::vector<double> detector = smooth;
  for (int i = -radius; i <= radius; ++i)
    detector[i + radius] *= points ? i * i / (sigma * sigma) - 1 : -i;
  NormalizeBySign(&detector);
  Image<float> strength = FilterSeparably(lightness, detector, smooth, pool);
  const Image<float> down = FilterSeparably(lightness, smooth, detector, pool);
  for (size_t i = 0; i < strength.pixels().size(); ++i)
    strength.pixels()[i] = std::hypot(strength.pixels()[i], down.pixels()[i]);
  return strength;
}

// One of the two pictures as the eye resolves it.
struct Seen {
  std::array<Image<float>, 3> filtered;  // opponent colours as the eye resolves them
  Image<float> edges, points;
};

Seen See(const Image<float>& rgb, double pixels_per_degree, ThreadPool& pool) {
  const int width = rgb.width(), height = rgb.height();
  std::array<Image<float>, 3> opponent;
  for (Image<float>& channel : opponent) channel = Image<float>(width, height);
  Image<float> lightness(width, height);
  pool.ForEach(height, [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const Vec3 colour = OpponentOf({rgb.at(x, y, 0), rgb.at(x, y, 1), rgb.at(x, y, 2)});
      for (int c = 0; c < 3; ++c) opponent[c].at(x, y) = static_cast<float>(colour[c]);
      lightness.at(x, y) = static_cast<float>((colour.x() + 16) / 116);
    }
  });
  Seen seen;
  const std::array of_channels = {kAchromatic, kRedGreen, kBlueYellow};
  for (int c = 0; c < 3; ++c)
    seen.filtered[c] = FilterBySensitivity(opponent[c], of_channels[c], pixels_per_degree, pool);
  seen.edges = FeatureStrength(lightness, false, pixels_per_degree, pool);
  seen.points = FeatureStrength(lightness, true, pixels_per_degree, pool);
  return seen;
}

Vec3 PerceivedColour(const Seen& seen, int x, int y) {
  const Vec3 rgb = RgbFromOpponent(
      {seen.filtered[0].at(x, y), seen.filtered[1].at(x, y), seen.filtered[2].at(x, y)});
  return HuntLabOf(rgb.cwiseMax(0.0).cwiseMin(1.0));
}

}  // namespace

Image<float> FlipErrors(const Image<float>& reference, const Image<float>& test,
                        double pixels_per_degree, ThreadPool& pool) {
  const Seen a = See(reference, pixels_per_degree, pool), b = See(test, pixels_per_degree, pool);
  const double largest =
      std::pow(HybridDistance(HuntLabOf({0, 1, 0}), HuntLabOf({0, 0, 1})), kColourExponent);
  const double bend = kBendAt * largest;
  Image<float> errors(reference.width(), reference.height());
  pool.ForEach(errors.height(), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < errors.width(); ++x) {
      const double distance = std::pow(
          HybridDistance(PerceivedColour(a, x, y), PerceivedColour(b, x, y)), kColourExponent);
      const double colour = distance < bend
                                ? distance * kBendTo / bend
                                : kBendTo + (distance - bend) / (largest - bend) * (1 - kBendTo);
      const double feature = std::max(std::abs(a.edges.at(x, y) - b.edges.at(x, y)),
                                      std::abs(a.points.at(x, y) - b.points.at(x, y)));
      errors.at(x, y) =
          static_cast<float>(std::pow(colour, 1 - std::pow(feature * M_SQRT1_2, kFeatureExponent)));
    }
  });
  return errors;
}

}  // namespace lf
