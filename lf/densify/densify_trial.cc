// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/core/check.h"
#include "lf/densify/folded_poses.h"
#include "lf/densify/working_image.h"
#include "lf/light_field/model/keep_images.h"
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

namespace {

// Tests a film, unless LF images contradict each other.
//   contradiction  is found if it is not null
Result<DensifyTrial> Try(const LightField& light_field, const DensifyChoices& choices,
                         std::span<const std::string> source, ThreadPool& pool,
                         Contradiction* contradiction) {
  LF_ASSIGN_OR_RETURN(const auto store, OpenStore(light_field, Mosaics::kToRgb));
  LF_ASSIGN_OR_RETURN(const DensifyPlan plan, PlanDensify(light_field, *store, choices, pool));
  DensifyTrial trial;
  trial.filled_radius_w = plan.filled_radius_w;
  trial.objection = plan.dense;
  if (!trial.objection.empty()) return trial;
  if (contradiction != nullptr && light_field.size() <= kMostChecked) {
    const PairSearch search = [&](std::span<const uint32_t> ids) {
      return ComparePairs(light_field, *store, ids, plan.range, pool);
    };
    LF_ASSIGN_OR_RETURN(*contradiction, FindContradiction(light_field, plan.serving, choices.frames,
                                                          source, search));
    if (!contradiction->text.empty()) return trial;
  }
  LF_ASSIGN_OR_RETURN(trial.tests, TestByLeavingOut(light_field, *store, plan, pool));
  trial.objection = ObjectionOf(TestsOf(trial.tests, false), plan.range, true);
  return trial;
}

}  // namespace

Result<DensifyTrial> TryDensify(const LightField& light_field, const DensifyChoices& choices,
                                std::span<const std::string> source, ThreadPool& pool) {
  LF_CHECK(!choices.frames.empty());
  LF_RETURN_IF_ERROR(CheckKind(light_field));
  LightField field = WithOpacities(light_field);
  Contradiction found;
  LF_ASSIGN_OR_RETURN(DensifyTrial trial, Try(field, choices, source, pool, &found));
  if (found.text.empty()) return trial;
  if (found.kept.empty()) {
    trial.objection = found.text;
    return trial;
  }
  KeepImages(found.kept, &field);
  LF_ASSIGN_OR_RETURN(trial, Try(field, choices, source, pool, nullptr));
  trial.left_out = found.text;
  return trial;
}

}  // namespace lf
