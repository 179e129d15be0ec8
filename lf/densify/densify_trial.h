// SPDX-License-Identifier: Apache-2.0
// Judges by the tests of virtual LF images whether they help, and makes these tests for a film
// before any is made.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/self_test.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the reason why virtual LF images are not worth making; "" if they are, or if nothing was
// tested. They are if the median gain is at least kLeastGainDb or, for a film, if they are not
// worse than the mean and their median is at least kRightDb.
std::string ObjectionOf(const std::vector<LeftOut>& tests, const InverseDepths& range,
                        bool is_film);

struct DensifyTrial {
  // The reason why virtual LF images do not help: the LF cameras are dense enough already, or the
  // test failed. Empty if they help, or if no LF image could be tested.
  std::string objection;
  // Says which LF images the film cannot use because their poses are wrong (FindContradiction());
  // the other fields are of those that are left. Empty if it can use all.
  std::string left_out;
  std::vector<LeftOut> tests;  // TestByLeavingOut(); empty if no LF image could be tested
  double filled_radius_w = 0;  // DensifyPlan::filled_radius_w
};

// Makes the plan for a film and tests it, at a fraction of the cost of Densify(). If LF images
// contradict each other, tests it with those of the group in its lenses.
//   choices  with frames
//   source   LIGHTFIELD and its options, as the user gave them, for the commands of messages
// Errors as CheckKind(), OpenStore(), PlanDensify() and TestByLeavingOut().
Result<DensifyTrial> TryDensify(const LightField& light_field, const DensifyChoices& choices,
                                std::span<const std::string> source, ThreadPool& pool);

}  // namespace lf
