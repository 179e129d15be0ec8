// SPDX-License-Identifier: Apache-2.0
#include "lf/import/report/exposure_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace lf {
namespace {

size_t MatchedCount(const MatchedExposure& exposure) {
  return exposure.gains.size() - exposure.left_alone.size() - exposure.unreadable.size();
}

// Returns exposures in stops as text, such as "-2, 0 and +2", rounded to hundredths.
std::string StopsText(const std::vector<double>& stops) {
  std::string text;
  for (size_t i = 0; i < stops.size(); ++i) {
    const double rounded = std::round(100 * stops[i]) / 100 + 0.0;
    text += i == 0 ? "" : i + 1 == stops.size() ? " and " : ", ";
    text += rounded > 0 ? fmt::format("+{}", rounded) : fmt::format("{}", rounded);
  }
  return text;
}

}  // namespace

std::string BracketsText(const FoundBrackets& brackets) {
  const std::string exposures =
      brackets.least_exposures == brackets.most_exposures
          ? fmt::format("{}", brackets.most_exposures)
          : fmt::format("{} to {}", brackets.least_exposures, brackets.most_exposures);
  return fmt::format("{} poses x {} exposures, {} stops by {}", brackets.pose_count, exposures,
                     StopsText(brackets.stops),
                     brackets.are_gains ? "lf_gain" : "what the files state");
}

std::string ExifGainsText(const ExifGains& gains) {
  return fmt::format("{:.5g} to {:.5g} for {} images, from the exposure that their files state",
                     gains.least_gain, gains.most_gain, gains.image_count);
}

nlohmann::ordered_json BracketsJson(const FoundBrackets& brackets) {
  return {{"poses", brackets.pose_count},
          {"images", brackets.image_count},
          {"exposures", {brackets.least_exposures, brackets.most_exposures}},
          {"stops", brackets.stops},
          {"from", brackets.are_gains ? "lf_gain" : "files"}};
}

nlohmann::ordered_json ExifGainsJson(const ExifGains& gains) {
  return {{"images", gains.image_count},
          {"gain_min", gains.least_gain},
          {"gain_max", gains.most_gain},
          {"has_f_numbers", gains.has_f_numbers}};
}

std::string ExposureText(const MatchedExposure& exposure) {
  return fmt::format(
      "{} of {} images matched by {} colours of places that two of them show: gains "
      "{:.3f} to {:.3f}",
      MatchedCount(exposure), exposure.gains.size(), exposure.sample_count, exposure.least_gain,
      exposure.most_gain);
}

std::string SeamsText(const MatchedExposure& exposure) {
  return fmt::format("{:.2f} % between neighbouring images before, {:.2f} % after",
                     100 * exposure.step_before, 100 * exposure.step_after);
}

std::string FalloffText(const FoundFalloff& falloff) {
  const std::string min = fmt::format("{:.1f}", 100 * falloff.corner_min);
  const std::string max = fmt::format("{:.1f}", 100 * falloff.corner_max);
  return fmt::format(
      "{} % of the light is left in the corners; a tenth of the compared places lie "
      "beyond {:.2f} of the distance from the axis to the corners",
      min == max ? min : fmt::format("{} to {}", min, max), falloff.reach);
}

nlohmann::ordered_json ExposureJson(const MatchedExposure& exposure) {
  nlohmann::ordered_json json = {
      {"matched", MatchedCount(exposure)}, {"groups", exposure.component_count},
      {"samples", exposure.sample_count},  {"gain_min", exposure.least_gain},
      {"gain_max", exposure.most_gain},    {"step_before", exposure.step_before},
      {"step_after", exposure.step_after}, {"falloff", nullptr}};
  if (exposure.falloff)
    json["falloff"] = {{"corner_min", exposure.falloff->corner_min},
                       {"corner_max", exposure.falloff->corner_max},
                       {"reach", exposure.falloff->reach},
                       {"cameras", exposure.falloff->camera_count}};
  return json;
}

}  // namespace lf
