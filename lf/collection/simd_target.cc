// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/simd_target.h"

#include <hwy/highway.h>

namespace lf {

std::vector<std::string> SimdTargets() {
  std::vector<std::string> names;
  // Highway lists the targets from the lowest bit on; better targets have lower bits.
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

bool UseSimdTarget(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  if (name.empty()) return true;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().DeInit();
      return true;
    }
  return false;
}

}  // namespace lf
