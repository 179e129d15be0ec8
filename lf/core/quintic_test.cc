// SPDX-License-Identifier: Apache-2.0
#include "lf/core/quintic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lf {
namespace {

TEST(Quintic, FindsThePowersOfAPolynomial) {
  const std::array<double, 6> powers = {3, -2, 0.5, 7, -0.25, 11};
  std::array<double, 6> at;
  for (size_t i = 0; i < 6; ++i) at[i] = QuinticAt(powers, kQuinticPlaces[i]);
  const std::array<double, 6> found = QuinticThrough(at);
  for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(found[k], powers[k], 1e-12) << k;
}

TEST(Quintic, MissesMostAtItsWorstPlaces) {
  const auto smooth = [](double t) { return std::exp(0.3 * t); };
  std::array<double, 6> at;
  for (size_t i = 0; i < 6; ++i) at[i] = smooth(kQuinticPlaces[i]);
  const std::array<double, 6> found = QuinticThrough(at);
  double worst = 0, anywhere = 0;
  for (const double t : kQuinticWorstPlaces)
    worst = std::max(worst, std::abs(QuinticAt(found, t) - smooth(t)));
  for (int i = -1000; i <= 1000; ++i)
    anywhere = std::max(anywhere, std::abs(QuinticAt(found, i / 1000.0) - smooth(i / 1000.0)));
  EXPECT_GT(anywhere, 1e-9);
  EXPECT_LE(anywhere, 1.01 * worst);
}

}  // namespace
}  // namespace lf
