// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/guard_share.h"

#include <algorithm>

#include "lf/core/smooth_step.h"

namespace lf {
namespace {

// Returns the mean of rays whose values are those of opacities.
double MeanShareOf(const ElementSum& rays, const DevelopOptions& options) {
  return (rays.Mean() - options.transparent) / (options.opaque - options.transparent);
}

}  // namespace

GuardShare GuardShareOf(const SensorPlate& plate, const DevelopOptions& options, int x, int y) {
  const ElementSum defocus = plate.At(x, y, plate.defocus_channel());
  const ElementSum trust = plate.At(x, y, plate.trust_channel());
  if (trust.count == 0) return {defocus.count == 0 ? 1.0 : 0.0, 1};
  const double trusted = std::clamp(MeanShareOf(trust, options), 0.0, 1.0);
  const bool is_doubtful = trusted < kDoubtfulTrust;
  if (defocus.count == 0) return {1, trusted, is_doubtful};
  const double blurred = SmoothStep(MeanShareOf(defocus, options), kGuardFrom, kGuardTo);
  if (blurred == 0) return {};
  const double single =
      options.effective_count
          ? std::clamp(2.0 - static_cast<double>(options.effective_count->at(x, y)), 0.0, 1.0)
          : 1;
  const double shown = 1 - single * (1 - SmoothStep(trusted, kTrustFrom, kTrustTo));
  return {blurred * shown, trusted, is_doubtful && blurred > 0.5};
}

}  // namespace lf
