// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/core/check.h"
#include "lf/densify/working_image.h"
#include "lf/storage/load/open_store.h"

namespace lf {

std::string ObjectionOf(const std::vector<LeftOut>& tests, const InverseDepths& range,
                        bool is_film) {
  if (tests.empty()) return "";
  const double gain_db = MedianGainDb(tests), psnr_db = MedianPsnrDb(tests);
  if (gain_db >= kLeastGainDb) return "";
  // A mean of neighbours may be as right at one depth, but it cannot blur as a lens does.
  if (is_film && gain_db >= 0 && psnr_db >= kRightDb) return "";
  const auto worst =
      std::min_element(tests.begin(), tests.end(),
                       [](const LeftOut& a, const LeftOut& b) { return a.GainDb() < b.GainDb(); });
  const std::string reason =
      psnr_db >= kNearlyRightDb
          ? std::string(
                "The mean is nearly right, because neighbouring LF images differ little: render "
                "the light field as it is, or try {force}")
          : fmt::format(
                "Poses may be wrong, for example where equal patterns were confused, or the depths "
                "({:.4g} to {:.4g}): check the poses, state {{depths}}, or try {{force}}",
                1 / range.greatest, range.least > 0 ? 1 / range.least : INFINITY);
  return fmt::format(
      "{} LF images were left out in turn and made from their neighbours: at {:.0f} dB, the result "
      "is only {:.1f} dB better than a mean of the neighbours, expected at least {} dB (worst: {}, "
      "{:.1f} dB). {}",
      tests.size(), psnr_db, gain_db, kLeastGainDb, worst->name, worst->GainDb(), reason);
}

Result<DensifyTrial> TryDensify(const LightField& light_field, const DensifyChoices& choices,
                                ThreadPool& pool) {
  LF_CHECK(!choices.frames.empty());
  LF_RETURN_IF_ERROR(CheckKind(light_field));
  DensifyTrial trial;
  const LightField field = WithOpacities(light_field);
  LF_ASSIGN_OR_RETURN(const auto store, OpenStore(field, Mosaics::kToRgb));
  LF_ASSIGN_OR_RETURN(const DensifyPlan plan, PlanDensify(field, *store, choices, pool));
  trial.filled_radius_w = plan.filled_radius_w;
  trial.objection = plan.dense;
  if (!trial.objection.empty()) return trial;
  LF_ASSIGN_OR_RETURN(trial.tests, TestByLeavingOut(field, *store, plan, pool));
  trial.objection = ObjectionOf(TestsOf(trial.tests, false), plan.range, true);
  return trial;
}

}  // namespace lf
