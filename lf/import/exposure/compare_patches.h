// SPDX-License-Identifier: Apache-2.0
// Compares the light of a patch in two LF images. Pixels at the edges of objects get little weight:
// their light depends on where the pixel grid lies, and therefore differs between the images much
// more than the light of smooth areas.
#pragma once

#include <array>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/focus/place_depth.h"
#include "lf/import/exposure/exposure_views.h"
#include "lf/import/exposure/fit_exposure.h"

namespace lf {

// Light in R, G and B, as in ExposureView::light, of a patch of 13 x 13 pixels of a view and of the
// pixels around it, row by row; 0 if a pixel is masked, clipped, or outside the image.
inline constexpr int kPatchWindowSide = 15;
using PatchWindow = std::array<std::array<float, 3>, size_t{kPatchWindowSide} * kPatchWindowSide>;

// One of the two LF images that are compared.
struct ComparedImage {
  const ExposureView& view;
  const Intrinsics& intrinsics;
};

// The 13 x 13 pixels, of the view of an LF image, around a place. They are compared with the views
// of other LF images at the same place of the scene.
class ComparedPatch {
 public:
  //   a      the LF image of the patch; its view and intrinsics must outlive the patch
  //   white  radiance that the largest value of ExposureView::light stands for
  ComparedPatch(const ComparedImage& a, const Place& place, double white);

  // Returns a sample that compares this patch with the same place in b; the caller sets
  // ExposureSample::a and b. A pixel is used if it and its four neighbours are above 0 in the
  // PatchWindow of both LF images. The weight of a pixel is the inverse of its variance, estimated
  // from noise and from a share of the step to its neighbours. The deviations of the sample's
  // ratios are computed from the residuals of the pixels. None if fewer than two thirds of the
  // pixels are used, or if all channels are dark.
  //   grid  positions in b of the pixels of the patch (PatchSeenBy()); used for all pixels of the
  //         PatchWindow
  std::optional<ExposureSample> CompareWith(const ComparedImage& b, const PatchGrid& grid) const;

 private:
  const ComparedImage a_;
  const double scale_;  // radiance of one step of ExposureView::light
  const PatchGrid grid_;
  const PatchWindow window_;
};

}  // namespace lf
