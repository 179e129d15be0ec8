// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/split_film.h"

#include <algorithm>

namespace lf {

std::vector<Section> SplitByCost(std::span<const uint64_t> costs, size_t count) {
  const size_t frame_count = costs.size();
  count = std::min(count, frame_count);
  std::vector<double> cost_before(frame_count + 1, 0);
  for (size_t i = 0; i < frame_count; ++i)
    cost_before[i + 1] = cost_before[i] + static_cast<double>(costs[i]);
  std::vector<Section> sections;
  size_t begin = 0;
  for (size_t k = 1; k <= count; ++k) {
    // `target` is the cost at which the section should end. It divides the remaining cost, not the
    // total cost, equally, so that one costly frame does not make the following sections small.
    const double target = cost_before[begin] + (cost_before.back() - cost_before[begin]) /
                                                   static_cast<double>(count - k + 1);
    const auto first = cost_before.begin();
    auto end = static_cast<size_t>(
        std::lower_bound(first + static_cast<ptrdiff_t>(begin), cost_before.end(), target) - first);
    if (end > begin && target - cost_before[end - 1] < cost_before[end] - target) --end;
    end = k == count ? frame_count
                     // every section gets at least one frame
                     : std::clamp(end, begin + 1, frame_count - (count - k));
    sections.push_back({begin, end});
    begin = end;
  }
  return sections;
}

std::vector<Section> SplitToFit(std::span<const uint64_t> costs, size_t most_frames) {
  const auto fits = [&](const Section& section) { return section.size() <= most_frames; };
  size_t count = (costs.size() + most_frames - 1) / most_frames;
  while (true) {
    std::vector<Section> sections = SplitByCost(costs, count);
    if (std::all_of(sections.begin(), sections.end(), fits)) return sections;
    ++count;
  }
}

}  // namespace lf
