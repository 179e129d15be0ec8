// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/fill_depths.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lf {
namespace {

// Sums of weights times values, and of weights.
struct Level {
  Image<float> sums;
  Image<float> weights;
};

// Returns the next level, in which each element is that of 2 x 2 elements.
Level Coarser(const Level& fine) {
  const int width = (fine.sums.width() + 1) / 2, height = (fine.sums.height() + 1) / 2;
  Level coarse{Image<float>(width, height), Image<float>(width, height)};
  for (int y = 0; y < fine.sums.height(); ++y)
    for (int x = 0; x < fine.sums.width(); ++x) {
      coarse.sums.at(x / 2, y / 2) += fine.sums.at(x, y);
      coarse.weights.at(x / 2, y / 2) += fine.weights.at(x, y);
    }
  return coarse;
}

// Returns the value of a filled coarse level in the middle of an element (x, y) of the finer level.
float Between(const Image<float>& coarse, int x, int y) {
  const double across = 0.5 * (x + 0.5) - 0.5, down = 0.5 * (y + 0.5) - 0.5;
  const int left = static_cast<int>(std::floor(across)), upper = static_cast<int>(std::floor(down));
  const auto at = [&](int column, int row) {
    return coarse.at(std::clamp(column, 0, coarse.width() - 1),
                     std::clamp(row, 0, coarse.height() - 1));
  };
  const auto u = static_cast<float>(across - left), v = static_cast<float>(down - upper);
  return (1 - v) * ((1 - u) * at(left, upper) + u * at(left + 1, upper)) +
         v * ((1 - u) * at(left, upper + 1) + u * at(left + 1, upper + 1));
}

}  // namespace

Image<float> FilledDepths(const Image<float>& values, const Image<float>& weights,
                          float otherwise) {
  std::vector<Level> levels = {{Image<float>(values.width(), values.height()),
                                Image<float>(values.width(), values.height())}};
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x) {
      if (std::isnan(values.at(x, y))) continue;
      levels[0].sums.at(x, y) = values.at(x, y) * weights.at(x, y);
      levels[0].weights.at(x, y) = weights.at(x, y);
    }
  while (levels.back().sums.width() > 1 || levels.back().sums.height() > 1)
    levels.push_back(Coarser(levels.back()));
  Image<float> filled(1, 1, 1, otherwise);
  if (levels.back().weights.at(0, 0) > 0)
    filled.at(0, 0) = levels.back().sums.at(0, 0) / levels.back().weights.at(0, 0);
  for (size_t i = levels.size() - 1; i-- > 0;) {
    const Level& level = levels[i];
    Image<float> finer(level.sums.width(), level.sums.height());
    for (int y = 0; y < finer.height(); ++y)
      for (int x = 0; x < finer.width(); ++x)
        finer.at(x, y) = level.weights.at(x, y) > 0 ? level.sums.at(x, y) / level.weights.at(x, y)
                                                    : Between(filled, x, y);
    filled = std::move(finer);
  }
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x)
      if (!std::isnan(values.at(x, y))) filled.at(x, y) = values.at(x, y);
  return filled;
}

}  // namespace lf
