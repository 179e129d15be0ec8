// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/principal_axes.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lf {

Vec3 MeanOf(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points)
    sum = {sum.x() + point.x(), sum.y() + point.y(), sum.z() + point.z()};
  const auto count = static_cast<double>(points.size());
  return {sum.x() / count, sum.y() / count, sum.z() / count};
}

// Jacobi's method (Golub, Van Loan, "Matrix Computations", 8.5): each rotation makes one element
// beside the diagonal zero.
PrincipalAxes AxesOf(std::span<const Vec3> points) {
  constexpr int kSweeps = 12;
  double m[3][3] = {}, v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3& p : points)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] += p[i] * p[j] / static_cast<double>(points.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      if (m[p][q] == 0) continue;
      const double tau = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
      const double c = 1 / std::sqrt(1 + t * t), s = t * c;
      const auto turn = [c = c, s = s](double* a, double* b) {
        const double old = *a;
        *a = c * old - s * *b;
        *b = s * old + c * *b;
      };
      for (auto& row : m) turn(&row[p], &row[q]);
      for (int k = 0; k < 3; ++k) turn(&m[p][k], &m[q][k]);
      for (auto& row : v) turn(&row[p], &row[q]);
    }
  std::array<int, 3> by_variance = {0, 1, 2};
  std::stable_sort(by_variance.begin(), by_variance.end(),
                   [&](int a, int b) { return m[a][a] > m[b][b]; });
  PrincipalAxes result;
  for (size_t k = 0; k < 3; ++k) {
    const int column = by_variance[k];
    result.axes[k] = {v[0][column], v[1][column], v[2][column]};
    result.variances[k] = std::max(0.0, m[column][column]);
  }
  return result;
}

}  // namespace lf
