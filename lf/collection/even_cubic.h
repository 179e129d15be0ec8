// The cubic through four even points. Internal to collection.
#pragma once

namespace lf {

// c[0] + c[1] t + c[2] t^2 + c[3] t^3 through the values e at t = -1, -1/3, 1/3, 1 times `half`.
inline void InterpolateEven(const double (&e)[4], double half, double (&c)[4]) {
  c[0] = (9 * (e[1] + e[2]) - (e[0] + e[3])) / 16;
  c[1] = (27 * (e[2] - e[1]) - (e[3] - e[0])) / 16 / half;
  c[2] = 9 * ((e[0] + e[3]) - (e[1] + e[2])) / 16 / (half * half);
  c[3] = 9 * ((e[3] - e[0]) - 3 * (e[2] - e[1])) / 16 / (half * half * half);
}

}  // namespace lf
