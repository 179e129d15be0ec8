// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/ssim.h"

#include "lf/film/compare/separable_filter.h"

namespace lf {

Image<float> StructuralSimilarity(const Image<float>& a, const Image<float>& b, ThreadPool& pool) {
  constexpr double kOfMeans = 0.01 * 0.01, kOfVariances = 0.03 * 0.03;
  const std::vector<double> window = GaussianWeights(1.5, kSsimRadius);
  const int width = a.width(), height = a.height();
  // Values about 1/2 lose fewer bits in the differences of second moments below.
  Image<float> first(width, height), second(width, height), squares(width, height),
      products(width, height);
  pool.ForEach(height, [&](size_t y) {
    for (int x = 0; x < width; ++x) {
      const int row = static_cast<int>(y);
      const float u = a.at(x, row) - 0.5f, v = b.at(x, row) - 0.5f;
      first.at(x, row) = u;
      second.at(x, row) = v;
      squares.at(x, row) = u * u + v * v;
      products.at(x, row) = u * v;
    }
  });
  const Image<float> mean_a = FilterSeparably(first, window, window, pool);
  const Image<float> mean_b = FilterSeparably(second, window, window, pool);
  const Image<float> mean_squares = FilterSeparably(squares, window, window, pool);
  const Image<float> mean_products = FilterSeparably(products, window, window, pool);
  Image<float> similarity(width, height);
  pool.ForEach(height, [&](size_t y) {
    for (int x = 0; x < width; ++x) {
      const int row = static_cast<int>(y);
      const double u = mean_a.at(x, row), v = mean_b.at(x, row);
      const double variances = mean_squares.at(x, row) - u * u - v * v;
      const double covariance = mean_products.at(x, row) - u * v;
      const double p = u + 0.5, q = v + 0.5;
      similarity.at(x, row) =
          static_cast<float>((2 * p * q + kOfMeans) * (2 * covariance + kOfVariances) /
                             ((p * p + q * q + kOfMeans) * (variances + kOfVariances)));
    }
  });
  return similarity;
}

}  // namespace lf
