// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/transmitted_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lf/core/random.h"
#include "lf/selection/lens_weights/lens_cells.h"

namespace lf {
namespace {

Transmission Random(int side, uint64_t seed) {
  Image<uint8_t> shares(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      shares.at(x, y) =
          static_cast<uint8_t>(255 * RandomUnit(seed, static_cast<uint64_t>(y * side + x), 0));
  return *Transmission::Of(shares);
}

// The mean over many points decides.
TEST(TransmittedLightTest, IsTheIntegralOverThePolygon) {
  for (const Aperture& aperture : {Aperture{1, 0, 0}, Aperture{2.5, 5, 0.4},
                                   Aperture{1.5, 0, 0.7, 2, 0}, Aperture{1.5, 7, -0.3, 0.4, 0.5}})
    for (const int side : {1, 4, 13}) {
      const Transmission transmission = Random(side, static_cast<uint64_t>(side));
      ConvexPolygon polygon(RimVertices(aperture));
      polygon.Clip(Vec2(0.6, 0.8), 0.3 * aperture.radius_w);
      const double area = polygon.Area();
      double sum = 0;
      constexpr int kSide = 300;
      const std::vector<Vec2> rim = RimVertices(aperture);
      for (int i = 0; i < kSide * kSide; ++i) {
        const Vec2 unit((i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide);
        const Vec2 point = aperture.radius_w * (2.2 * unit - Vec2(1.1, 1.1));
        if (Vec2(0.6, 0.8).dot(point) > 0.3 * aperture.radius_w) continue;
        bool is_within = true;
        for (size_t k = 0; is_within && k < rim.size(); ++k)
          is_within = Cross(rim[(k + 1) % rim.size()] - rim[k], point - rim[k]) >= 0;
        if (is_within) sum += LightThrough(transmission, aperture, point);
      }
      const double expected = sum * std::pow(2.2 * aperture.radius_w / kSide, 2);
      EXPECT_NEAR(TransmittedLight(transmission, aperture, polygon), expected, 4e-3 * area);
    }
}

TEST(TransmittedLightTest, WholeWhiteIsTheArea) {
  const Transmission white = *Transmission::FromText("ffff/ffff");
  for (const Aperture& aperture : {Aperture{1, 6, 0.1}, Aperture{3, 4, 0.2, 3, 0}}) {
    const ConvexPolygon opening(Vertices(aperture));
    EXPECT_NEAR(TransmittedLight(white, aperture, opening), opening.Area(), 1e-12 * opening.Area());
  }
}

// Cells of a transmission: the parts of the light sum up to 1, and dark cells have no share.
TEST(TransmittedLightTest, SharesOfCellsSumUpToOne) {
  const Aperture aperture{1, 0, 0};
  const Transmission right_half = *Transmission::FromText("00ff/00ff");
  std::vector<Vec2> points;
  for (int i = 0; i < 60; ++i)
    points.push_back({2 * RandomUnit(7, static_cast<uint64_t>(i), 0) - 1,
                      2 * RandomUnit(7, static_cast<uint64_t>(i), 1) - 1});
  points.push_back({-0.5, 0});
  points.push_back({-0.4, 0});
  points.push_back({0.4, 0});
  const auto shares = CellShares(
      points, ConvexPolygon(RimVertices(aperture)), {},
      [&](const ConvexPolygon& part) { return TransmittedLight(right_half, aperture, part); });
  double sum = 0;
  for (const double share : shares) sum += share;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(shares[60], 0);
  EXPECT_GT(shares[62], 0);
}

}  // namespace
}  // namespace lf
