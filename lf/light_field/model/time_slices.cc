// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/time_slices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/core/check.h"

namespace lf {

size_t NearestTime(std::span<const double> ascending, double time) {
  LF_CHECK(!ascending.empty());
  const auto after = std::lower_bound(ascending.begin(), ascending.end(), time);
  if (after == ascending.begin()) return 0;
  const auto index = static_cast<size_t>(after - ascending.begin());
  if (after == ascending.end()) return index - 1;
  // Times in the middle are often rounded. They must not jump between the two.
  constexpr double kEquallyNear = 1e-6;
  const double before = time - ascending[index - 1], behind = ascending[index] - time;
  return before - behind <= kEquallyNear * (before + behind) ? index - 1 : index;
}

std::vector<double> DistinctTimes(std::span<const double> times) {
  constexpr double kTolerance = 1e-6;
  std::vector<double> sorted(times.begin(), times.end());
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return sorted;
  const double least_step = kTolerance * (sorted.back() - sorted.front());
  std::vector<double> distinct = {sorted.front()};
  for (const double time : sorted)
    if (time - distinct.back() > least_step) distinct.push_back(time);
  return distinct;
}

std::optional<double> RateOfTimes(std::span<const double> ascending) {
  constexpr double kUneven = 0.25;
  if (ascending.size() < 2) return std::nullopt;
  const double step =
      (ascending.back() - ascending.front()) / static_cast<double>(ascending.size() - 1);
  if (!(step > 0)) return std::nullopt;
  for (size_t i = 1; i < ascending.size(); ++i)
    if (!(std::abs(ascending[i] - ascending[i - 1] - step) <= kUneven * step)) return std::nullopt;
  return 1 / step;
}

std::string TextOfSpan(const VideoFacts& video) {
  std::string text = fmt::format("from {:.5g} to {:.5g}{} ({} times", video.begin, video.end,
                                 video.is_in_seconds ? " s" : "", video.slice_count);
  if (video.rate)
    text += fmt::format(", {:.5g} per {}", *video.rate, video.is_in_seconds ? "second" : "unit");
  return text + ")";
}

SliceOfFrame::SliceOfFrame(const LightField& light_field,
                           const std::optional<double>& recording_time) {
  const std::vector<double>& slices = light_field.slice_times;
  if (slices.size() < 2) return;
  LF_CHECK(light_field.times.size() == light_field.size());
  times_ = light_field.times.data();
  time_ = recording_time ? slices[NearestTime(slices, *recording_time)] : slices.front();
}

}  // namespace lf
