// SPDX-License-Identifier: Apache-2.0
// Values of settings for tests.
#pragma once

#include <string>

#include "lf/render/settings/setting_table.h"

namespace lf::testing {

// Returns a text that the setting accepts, of another value than the default.
inline std::string AnotherOf(const Setting& setting) {
  const std::string usual = setting.get(FilmSettings());
  if (!setting.words.empty())
    return std::string(usual == setting.words[0] ? setting.words[1] : setting.words[0]);
  if (setting.kind == SettingKind::kPoint) return "0.25 -1 3";
  if (setting.key == "max_rays") return "2000";
  if (setting.key == "stop_when" || setting.key == "require") return "noise<=0.25";
  return setting.least > 1 || usual == "1" ? "5" : "1";
}

}  // namespace lf::testing
