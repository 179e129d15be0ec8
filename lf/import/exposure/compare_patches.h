// Compares the light of a patch in two LF images. Pixels at edges count little, because they depend
// on how the pixel grid and the interpolation cut the edge, and so differ much more than smooth
// light.
#pragma once

#include <array>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/focus/place_depth.h"
#include "lf/import/exposure/exposure_views.h"
#include "lf/import/exposure/fit_exposure.h"

namespace lf {

// Light in R, G and B of 13 x 13 pixels and of the pixels around them; 0 if it is not recorded.
inline constexpr int kPatchWindowSide = 15;
using PatchWindow = std::array<std::array<float, 3>, kPatchWindowSide * kPatchWindowSide>;

// One of the two LF images that are compared.
struct ComparedImage {
  const ExposureView& view;
  const Intrinsics& intrinsics;
};

// The 13 x 13 pixels around a place of an LF image, to be compared with the same place in other LF
// images.
class ComparedPatch {
 public:
  //   a      must outlive the patch
  //   white  radiance of the largest value of ExposureView::light
  ComparedPatch(const ComparedImage& a, const Place& place, double white);

  // Returns the sample of this patch and the same place in b. A pixel counts if it and its four
  // neighbours are recorded in both LF images. Its weight is its inverse variance, from noise and
  // from a part of the gradient. The deviations of the sample's ratios follow from the residuals of
  // the pixels. None if too few pixels count, or if all channels are dark.
  //   grid  the place as b shows it (PatchSeenBy())
  std::optional<ExposureSample> CompareWith(const ComparedImage& b, const PatchGrid& grid) const;

 private:
  const ComparedImage a_;
  const double scale_;  // radiance of one step of light
  const PatchGrid grid_;
  const PatchWindow window_;
};

}  // namespace lf
