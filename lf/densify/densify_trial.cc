// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_trial.h"

#include <utility>

#include "lf/core/check.h"

namespace lf {

Result<DensifyTrial> TryDensify(const LightField& light_field, const LfImageStore& store,
                                const DensifyChoices& choices, ThreadPool& pool) {
  LF_CHECK(!choices.frames.empty());
  DensifyTrial trial;
  LF_ASSIGN_OR_RETURN(const DensifyPlan plan, PlanDensify(light_field, store, choices, pool));
  trial.filled_radius_w = plan.filled_radius_w;
  trial.objection = plan.dense;
  if (!trial.objection.empty()) return trial;
  LF_ASSIGN_OR_RETURN(trial.tests, TestByLeavingOut(light_field, store, plan, pool));
  trial.objection = ObjectionOf(TestsOf(trial.tests, false), plan.range, true);
  return trial;
}

}  // namespace lf
