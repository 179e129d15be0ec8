// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_trial.h"

#include <utility>

#include "lf/core/check.h"
#include "lf/densify/working_image.h"
#include "lf/storage/load/open_store.h"

namespace lf {

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
