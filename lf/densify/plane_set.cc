// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/plane_set.h"

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr int kBetweenRuns = 2;  // entries without a depth between two runs of planes

}  // namespace

PlaneSet PlaneSet::All(int planes) {
  PlaneSet set;
  set.runs_ = {{0, planes, 0}};
  return set;
}

PlaneSet PlaneSet::Marked(std::span<const uint8_t> marks) {
  PlaneSet set;
  for (int plane = 0; plane < static_cast<int>(marks.size()); ++plane) {
    if (marks[static_cast<size_t>(plane)] == 0) continue;
    if (set.runs_.empty()) {
      set.runs_.push_back({plane, 1, 0});
      continue;
    }
    Run& last = set.runs_.back();
    if (plane - last.End() <= kBetweenRuns)
      last.count = plane + 1 - last.first;
    else
      set.runs_.push_back({plane, 1, last.entry + last.count + kBetweenRuns});
  }
  LF_CHECK(!set.runs_.empty());
  return set;
}

bool PlaneSet::operator==(const PlaneSet& other) const {
  return std::equal(runs_.begin(), runs_.end(), other.runs_.begin(), other.runs_.end(),
                    [](const Run& a, const Run& b) {
                      return a.first == b.first && a.count == b.count && a.entry == b.entry;
                    });
}

std::vector<float> PlaneSet::Depths(const InverseDepths& range, int planes) const {
  const double step = (range.greatest - range.least) / (planes - 1);
  std::vector<float> depths(static_cast<size_t>(entries()), NAN);
  for (const Run& run : runs_)
    for (int i = 0; i < run.count; ++i)
      depths[static_cast<size_t>(run.entry + i)] =
          static_cast<float>(range.least + (run.first + i) * step);
  return depths;
}

const PlaneSet::Run& PlaneSet::RunAt(int entry) const {
  const auto behind =
      std::find_if(runs_.begin(), runs_.end(), [&](const Run& run) { return run.entry > entry; });
  return *(behind - 1);
}

}  // namespace lf
