// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/densify_work.h"

#include <algorithm>
#include <numeric>

#include "lf/densify/depth_sweep.h"

namespace lf {
namespace {

constexpr const char* kNames[kDensifyStepCount] = {"checked LF images",  "searched LF images",
                                                   "compared pairs",     "tests",
                                                   "recorded LF images", "depths",
                                                   "compared depths",    "compared depths again",
                                                   "stored depths",      "virtual LF images"};

// In comparisons for each pixel; measured on photographs of 1 megapixel.
constexpr double kLoading = 6, kEncoding = 12, kSynthesis = 72, kAgreeing = 20;
// Widths of LF images that are reduced for the search and the tests, and for pairs.
constexpr double kReducedWidth = 200, kPairWidth = 100;

double PixelsOf(const LightField& light_field, uint32_t id) {
  const Intrinsics k = light_field.Camera(LfImageId{id}).intrinsics;
  return static_cast<double>(k.width_px) * k.height_px;
}

double PixelsOf(const LightField& light_field) {
  double pixels = 0;
  for (uint32_t id = 0; id < light_field.size(); ++id) pixels += PixelsOf(light_field, id);
  return pixels;
}

// Returns the pixels of an LF image that is reduced to a width.
double ReducedPixels(const LightField& light_field, double width) {
  const Intrinsics k = light_field.Camera(LfImageId{0}).intrinsics;
  return width * width * k.height_px / k.width_px;
}

}  // namespace

const char* NameOf(DensifyStep step) { return kNames[static_cast<size_t>(step)]; }

DensifyWork::DensifyWork(const LightField& light_field, const DensifyChoices& choices) {
  constexpr double kDepths = 128, kViews = 8, kVirtual = 400;
  const auto count = static_cast<double>(light_field.size());
  const double pixels = PixelsOf(light_field);
  const double working = pixels / choices.divisor / choices.divisor;
  Of(DensifyStep::kChecking) = kLoading * pixels;
  if (!choices.depths)
    Of(DensifyStep::kRange) = kLoading * pixels * std::min(1.0, 56 / count) +
                              8 * ReducedPixels(light_field, kReducedWidth) * kDepths * kViews;
  Of(DensifyStep::kRecorded) = kEncoding * pixels;
  Of(DensifyStep::kDepths) = working * kDepths * kViews;
  Of(DensifyStep::kVirtual) = (kSynthesis + kEncoding) * working / count *
                              std::min(kVirtual, static_cast<double>(choices.most_virtual));
}

void DensifyWork::Plan(const LightField& light_field, const DensifyChoices& choices,
                       const DensifyPlan& plan) {
  constexpr double kTests = 8, kSources = 6, kBlends = 13, kPairsOfImage = 3, kPairDepths = 60;
  const double reduced = 1.0 / choices.divisor / choices.divisor;
  const double pixels = PixelsOf(light_field);
  const double planes = plan.planes, tested = ReducedPixels(light_field, kReducedWidth);
  const double narrower = light_field.Camera(LfImageId{0}).intrinsics.width_px / kReducedWidth;
  const double tested_planes = std::max(24.0, planes * choices.divisor / std::max(1.0, narrower));
  Of(DensifyStep::kPairs) =
      kLoading * pixels + kPairsOfImage * static_cast<double>(light_field.size()) * 2 *
                              ReducedPixels(light_field, kPairWidth) * kPairDepths * 2;
  Of(DensifyStep::kTests) = kLoading * pixels * 0.5 +
                            kTests * tested * (kSources * tested_planes * 8 + kBlends * kSynthesis);
  Of(DensifyStep::kRecorded) = (kLoading + kEncoding) * pixels;
  double swept = 0, compared = 0, stored = 0, made = 0;
  for (const uint32_t id : plan.swept) {
    const double of_image = PixelsOf(light_field, id);
    const Intrinsics k = light_field.Camera(LfImageId{id}).intrinsics;
    const double share = ComparedShare(k.width_px / choices.divisor, k.height_px / choices.divisor);
    swept += of_image * (kLoading + reduced * share * planes *
                                        static_cast<double>(plan.compare_with[id].size()));
    compared += of_image * reduced * kAgreeing;
  }
  for (const uint32_t id : plan.stored) stored += PixelsOf(light_field, id) * reduced * kEncoding;
  for (const VirtualCamera& wanted : plan.virtual_cameras)
    made +=
        static_cast<double>(wanted.camera.intrinsics.width_px) * wanted.camera.intrinsics.height_px;
  Of(DensifyStep::kDepths) = swept;
  Of(DensifyStep::kAgreement) = Of(DensifyStep::kAgreementAgain) = compared;
  Of(DensifyStep::kStoring) = stored;
  Of(DensifyStep::kVirtual) = made * (kSynthesis + kEncoding);
}

double DensifyWork::Done(DensifyStep step, double share) const {
  const auto index = static_cast<size_t>(step);
  return std::accumulate(of_step_.begin(), of_step_.begin() + static_cast<ptrdiff_t>(index),
                         share * of_step_[index]);
}

double DensifyWork::Total() const { return std::accumulate(of_step_.begin(), of_step_.end(), 0.0); }

}  // namespace lf
