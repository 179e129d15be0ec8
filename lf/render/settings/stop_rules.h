// SPDX-License-Identifier: Apache-2.0
// The rules by which a frame is good enough, as texts: "noise<=X" and "samples>=N". The rules
// themselves are in render/collect/noise_rule.h and sample_rule.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/result.h"

namespace lf {

// A rule of either kind, or none.
struct StopRule {
  std::optional<uint32_t> samples = {};  // elements have at least this number of rays
  std::optional<double> noise = {};      // the noise is at most this, in linear light
};

// Returns the rule of a text; no rule if the text is empty. kUsage: the text is no rule, or its
// number is out of range; the message begins with `name`, such as "{stop_when}".
Result<StopRule> ParseStopRule(const std::string& text, const std::string& name);

// Returns the text of a rule, such that ParseStopRule() returns exactly this rule.
std::string TextOf(const StopRule& rule);

}  // namespace lf
