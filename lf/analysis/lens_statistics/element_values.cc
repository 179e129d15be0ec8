// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/element_values.h"

#include <algorithm>
#include <array>

namespace lf {

void ElementValues::AddRow(const SensorPlate& plate, int y) {
  for (int x = 0; x < width_; ++x) {
    const ElementSum red = plate.At(x, y, 0);
    if (red.count == 0) continue;
    uint32_t& count = counts_[IndexOf(x, y)];
    for (size_t c = 0; c < channels_; ++c) {
      const ElementSum ray = plate.At(x, y, static_cast<int>(c));
      Of(x, y, c)[count] = static_cast<uint16_t>(ray.sum / std::max<uint64_t>(1, ray.count));
    }
    ++count;
  }
}

void ElementValues::TakeRow(int y, const LensStatisticOptions& options, SensorPlate* plate) {
  std::vector<RankedRay> rays;
  for (int x = 0; x < width_; ++x) {
    const uint32_t count = Count(x, y);
    if (count == 0) continue;
    const ValueRange ranks = RanksOf(options.statistic, options.trim, count);
    if (options.order == StatisticOrder::kChannels) {
      for (size_t c = 0; c < channels_; ++c)
        plate->Add(x, y, static_cast<int>(c), SumOfRanks(Values(x, y, c), ranks));
      continue;
    }
    TakeByLuminance(x, y, ranks, &rays, plate);
  }
}

void ElementValues::TakeByLuminance(int x, int y, const ValueRange& ranks,
                                    std::vector<RankedRay>* rays, SensorPlate* plate) {
  const bool has_opacity = plate->has_opacity();
  rays->clear();
  for (uint32_t i = 0; i < Count(x, y); ++i)
    rays->emplace_back(Values(x, y, 0)[i], Values(x, y, 1)[i], Values(x, y, 2)[i],
                       has_opacity ? Values(x, y, SensorPlate::kOpacityChannel)[i] : uint16_t{0});
  PutRanksInPlace(*rays, ranks);
  const uint64_t count = ranks.end - ranks.begin;
  std::array<uint64_t, 4> sums = {};
  for (size_t i = ranks.begin; i < ranks.end; ++i) {
    const RankedRay& ray = (*rays)[i];
    sums[0] += ray.red();
    sums[1] += ray.green();
    sums[2] += ray.blue;
    sums[3] += ray.opacity;
  }
  for (size_t c = 0; c < channels_; ++c) plate->Add(x, y, static_cast<int>(c), {sums[c], count});
}

}  // namespace lf
