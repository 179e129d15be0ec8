// SPDX-License-Identifier: Apache-2.0
// Tells whether virtual LF images would help a film, before any is made.
#pragma once

#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/self_test.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct DensifyTrial {
  // The reason why virtual LF images do not help: the LF cameras are dense enough already, or the
  // test failed. Empty if they help, or if no LF image could be tested.
  std::string objection;
  std::vector<LeftOut> tests;  // TestByLeavingOut(); empty if no LF image could be tested
  double filled_radius_w = 0;  // DensifyPlan::filled_radius_w
};

// Makes the plan for a film and tests it, at a fraction of the cost of Densify().
//   choices  with frames
// Errors as CheckKind(), OpenStore(), PlanDensify() and TestByLeavingOut().
Result<DensifyTrial> TryDensify(const LightField& light_field, const DensifyChoices& choices,
                                ThreadPool& pool);

}  // namespace lf
