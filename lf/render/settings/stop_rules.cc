// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/stop_rules.h"

#include <fmt/format.h>

#include <string_view>

#include "lf/core/parse_number.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {
namespace {

constexpr std::string_view kNoise = "noise<=", kSamples = "samples>=";
constexpr double kMostNoise = 1000;

Result<double> ParseNoise(const std::string& text, const std::string& name) {
  const std::optional<double> noise =
      text.starts_with(kNoise) ? ParseNumber(std::string_view(text).substr(kNoise.size()))
                               : std::nullopt;
  if (!noise || !(*noise > 0 && *noise <= kMostNoise))
    return UsageError(
        fmt::format("{} '{}': expected noise<=X with X above 0 and up to {}, such as noise<=0.002 "
                    "(linear light, white is 1)",
                    name, text, kMostNoise));
  return *noise;
}

Result<uint32_t> ParseSamples(const std::string& text, const std::string& name) {
  if (!text.starts_with(kSamples))
    return UsageError(
        fmt::format("{} '{}': expected a rule such as samples>=8 or noise<=0.002", name, text));
  const auto samples = ParseWhole<uint32_t>(std::string_view(text).substr(kSamples.size()));
  if (!samples || *samples < 1 || *samples > SensorPlate::kMaxCount)
    return UsageError(fmt::format("{} '{}': expected samples>=N with N from 1 to {}", name, text,
                                  SensorPlate::kMaxCount));
  return *samples;
}

}  // namespace

Result<StopRule> ParseStopRule(const std::string& text, const std::string& name) {
  StopRule rule;
  if (text.starts_with("noise")) {
    LF_ASSIGN_OR_RETURN(rule.noise, ParseNoise(text, name));
  } else if (!text.empty()) {
    LF_ASSIGN_OR_RETURN(rule.samples, ParseSamples(text, name));
  }
  return rule;
}

std::string TextOf(const StopRule& rule) {
  if (rule.noise) return fmt::format("{}{}", kNoise, *rule.noise);
  return rule.samples ? fmt::format("{}{}", kSamples, *rule.samples) : "";
}

}  // namespace lf
