// SPDX-License-Identifier: Apache-2.0
// How much work each step of the densifier is, so that progress is one number with time left.
// Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lf/densify/densify_plan.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The steps in their order.
enum class DensifyStep : uint8_t {
  kChecking,
  kRange,
  kPairs,
  kTests,
  kRecorded,
  kDepths,
  kAgreement,
  kAgreementAgain,
  kStoring,
  kVirtual,
};
inline constexpr size_t kDensifyStepCount = 10;

// Returns what the user sees of a step: the name of its items.
const char* NameOf(DensifyStep step);

// The unit is a comparison of a pixel with a neighbour at one depth, which takes about 5 ns. Other
// work counts as the comparisons that take as long.
class DensifyWork {
 public:
  // Guesses before there is a plan that all LF images are searched at a middling number of depths.
  DensifyWork(const LightField& light_field, const DensifyChoices& choices);
  // Computes the work of a plan; steps that are done keep their work.
  void Plan(const LightField& light_field, const DensifyChoices& choices, const DensifyPlan& plan);
  // Multiplies the work of a step, if a part of it was done in an earlier run.
  void Scale(DensifyStep step, double share) { Of(step) *= share; }

  // Returns the work up to here, if the share of a step is done.
  double Done(DensifyStep step, double share) const;
  double Total() const;

 private:
  double& Of(DensifyStep step) { return of_step_[static_cast<size_t>(step)]; }
  std::array<double, kDensifyStepCount> of_step_{};
};

}  // namespace lf
