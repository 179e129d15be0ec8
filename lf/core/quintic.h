// SPDX-License-Identifier: Apache-2.0
// Polynomials of degree 5 through six points, which approximate smooth functions.
#pragma once

#include <array>
#include <cstddef>

namespace lf {

// The points t in [-1, 1] where the polynomial equals the function that it approximates: the roots
// of Chebyshev's polynomial T_6, which spread the error evenly over [-1, 1].
inline constexpr std::array<double, 6> kQuinticPlaces = {-0.9659258262890683, -0.7071067811865476,
                                                         -0.2588190451025208, 0.2588190451025208,
                                                         0.7071067811865476,  0.9659258262890683};

// Points t in [-1, 1] where the polynomial differs most from the function that it approximates:
// three of the seven extremes of Chebyshev's T_6. To first order, the difference is equally large
// at all seven.
inline constexpr std::array<double, 3> kQuinticWorstPlaces = {-1, 0, 1};

// Returns the coefficients of c[0] + c[1] t + ... + c[5] t^5, whose values at kQuinticPlaces are
// `at`. T is a number or a vector of numbers.
template <class T>
std::array<T, 6> QuinticThrough(const std::array<T, 6>& at) {
  // The sum of the even powers, and the sum of the odd ones divided by t, are parabolas in u = t^2.
  const double u[3] = {kQuinticPlaces[5] * kQuinticPlaces[5], 0.5,
                       kQuinticPlaces[3] * kQuinticPlaces[3]};
  std::array<T, 6> c;
  for (const size_t odd : {0u, 1u}) {
    T e[3];
    for (size_t k = 0; k < 3; ++k)
      e[k] = odd ? T((at[5 - k] - at[k]) * (0.5 / kQuinticPlaces[5 - k]))
                 : T((at[5 - k] + at[k]) * 0.5);
    const T slope = (e[0] - e[1]) * (1 / (u[0] - u[1]));
    const T inner_slope = (e[1] - e[2]) * (1 / (u[1] - u[2]));
    c[odd + 4] = (slope - inner_slope) * (1 / (u[0] - u[2]));
    c[odd + 2] = slope - c[odd + 4] * (u[0] + u[1]);
    c[odd] = e[0] - slope * u[0] + c[odd + 4] * (u[0] * u[1]);
  }
  return c;
}

// Returns the polynomial's value at t, by Horner's rule. `Powers` is an array of the six
// coefficients.
template <class Powers, class T>
T QuinticAt(const Powers& c, T t) {
  return ((((c[5] * t + c[4]) * t + c[3]) * t + c[2]) * t + c[1]) * t + c[0];
}

}  // namespace lf
