// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/separable_filter.h"

#include <algorithm>
#include <cmath>

namespace lf {

Image<float> FilterSeparably(const Image<float>& picture, const std::vector<double>& across,
                             const std::vector<double>& down, ThreadPool& pool) {
  const int width = picture.width(), height = picture.height();
  const int right = static_cast<int>(across.size() / 2), below = static_cast<int>(down.size() / 2);
  Image<float> columns(width, height), result(width, height);
  pool.ForEach(height, [&](size_t row) {
    const int y = static_cast<int>(row);
    std::vector<double> sums(width, 0);
    for (int j = -below; j <= below; ++j) {
      const float* const from = picture.row(std::clamp(y + j, 0, height - 1));
      const double weight = down[j + below];
      for (int x = 0; x < width; ++x) sums[x] += weight * from[x];
    }
    std::copy(sums.begin(), sums.end(), columns.row(y));
  });
  pool.ForEach(height, [&](size_t row) {
    const int y = static_cast<int>(row);
    const float* const middle = columns.row(y);
    std::vector<float> padded(width + 2 * static_cast<size_t>(right));
    std::fill_n(padded.begin(), right, middle[0]);
    std::copy_n(middle, width, padded.begin() + right);
    std::fill_n(padded.end() - right, right, middle[width - 1]);
    std::vector<double> sums(width, 0);
    for (int i = 0; i <= 2 * right; ++i)
      for (int x = 0; x < width; ++x) sums[x] += across[i] * padded[x + i];
    std::copy(sums.begin(), sums.end(), result.row(y));
  });
  return result;
}

std::vector<double> GaussianWeights(double sigma, int radius) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace lf
