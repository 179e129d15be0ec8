// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/find_brackets.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lf/core/check.h"
#include "lf/light_field/model/brackets.h"

namespace lf {
namespace {

// Returns the different exposures, in ascending order. Unknown exposures (0 or NaN) are dropped. Of
// exposures that differ by less than the factor kOneExposure, only the smallest is kept.
std::vector<double> DifferentOnes(std::vector<double> exposures) {
  std::erase_if(exposures, [](double x) { return !(x > 0); });
  std::sort(exposures.begin(), exposures.end());
  std::vector<double> different;
  for (const double exposure : exposures)
    if (different.empty() || exposure >= kOneExposure * different.back())
      different.push_back(exposure);
  return different;
}

std::vector<double> StopsOf(const std::vector<double>& exposures) {
  std::vector<double> stops;
  const double middle = exposures[(exposures.size() - 1) / 2];
  for (const double exposure : exposures) stops.push_back(std::log2(exposure / middle));
  return stops;
}

std::optional<FoundBrackets> FindAmong(std::span<const uint32_t> firsts,
                                       std::span<const double> exposures) {
  std::map<uint32_t, std::vector<uint32_t>> poses;
  for (uint32_t i = 0; i < firsts.size(); ++i)
    if (firsts[i] != i) poses[firsts[i]].push_back(i);
  FoundBrackets found;
  found.of_images.resize(firsts.size(), false);
  for (auto& [first, others] : poses) {
    others.push_back(first);
    std::vector<double> of_pose;
    for (const uint32_t i : others) of_pose.push_back(exposures[i]);
    const std::vector<double> different = DifferentOnes(std::move(of_pose));
    if (different.size() < 2) continue;
    for (const uint32_t i : others) found.of_images[i] = true;
    found.image_count += others.size();
    found.least_exposures = found.pose_count == 0
                                ? different.size()
                                : std::min(found.least_exposures, different.size());
    if (different.size() > found.most_exposures) found.stops = StopsOf(different);
    found.most_exposures = std::max(found.most_exposures, different.size());
    ++found.pose_count;
  }
  if (found.pose_count == 0) return std::nullopt;
  return found;
}

}  // namespace

std::optional<FoundBrackets> FindBrackets(const LightField& light_field,
                                          std::span<const uint32_t> firsts,
                                          std::span<const double> lights) {
  LF_CHECK(firsts.size() == light_field.size());
  std::vector<double> by_gain;
  for (const LfCamera& camera : light_field.cameras) by_gain.push_back(ExposureOf(camera));
  std::optional<FoundBrackets> found = FindAmong(firsts, by_gain);
  if (found) found->are_gains = true;
  if (found || lights.empty()) return found;
  LF_CHECK(lights.size() == light_field.size());
  return FindAmong(firsts, lights);
}

}  // namespace lf
