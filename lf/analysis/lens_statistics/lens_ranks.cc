// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/lens_ranks.h"

#include <algorithm>
#include <cmath>

namespace lf {
namespace {

template <typename T>
void Partition(std::span<T> values, const ValueRange& ranks) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(ranks.begin);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(ranks.end);
  if (ranks.begin > 0) std::nth_element(values.begin(), begin, values.end());
  if (ranks.end < values.size()) std::nth_element(begin, end, values.end());
}

}  // namespace

ValueRange RanksOf(LensStatistic statistic, double trim, size_t count) {
  // Makes 0.29 of 100 values 29, although the product is a little below.
  constexpr double kRounding = 1e-9;
  switch (statistic) {
    case LensStatistic::kMin:
      return {0, 1};
    case LensStatistic::kMax:
      return {count - 1, count};
    case LensStatistic::kMedian:
      return {(count - 1) / 2, count / 2 + 1};
    case LensStatistic::kTrimmed: {
      const auto cut =
          static_cast<size_t>(std::floor(trim * static_cast<double>(count) + kRounding));
      const size_t most = (count - 1) / 2;
      return {std::min(cut, most), count - std::min(cut, most)};
    }
    case LensStatistic::kMean:
      break;
  }
  return {0, count};
}

ElementSum SumOfRanks(std::span<uint16_t> values, const ValueRange& ranks) {
  Partition(values, ranks);
  ElementSum sum{0, ranks.end - ranks.begin};
  for (size_t i = ranks.begin; i < ranks.end; ++i) sum.sum += values[i];
  return sum;
}

void PutRanksInPlace(std::span<RankedRay> rays, const ValueRange& ranks) { Partition(rays, ranks); }

}  // namespace lf
