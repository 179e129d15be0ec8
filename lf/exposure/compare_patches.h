// Compares the light of a patch in two LF images. Edges count little: their pixels differ by where
// the pixel grid and interpolation cut them, by much more than smooth light differs.
#pragma once

#include <array>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/exposure/exposure_views.h"
#include "lf/exposure/fit_exposure.h"
#include "lf/focus/place_depth.h"

namespace lf {

// Light of R, G and B of the 13 x 13 pixels and of those around them; 0 where it is not recorded.
inline constexpr int kPatchWindowSide = 15;
using PatchWindow = std::array<std::array<float, 3>, kPatchWindowSide * kPatchWindowSide>;

// What is compared, in one LF image.
struct ComparedImage {
  const ExposureView& view;
  const Intrinsics& intrinsics;
};

// The 13 x 13 pixels around a place of an LF image, to be compared with what others show there.
class ComparedPatch {
 public:
  //   a      must outlive the patch
  //   white  radiance of the largest value of `light`
  ComparedPatch(const ComparedImage& a, const Place& place, double white);

  // The sample of it and what b shows. A pixel counts if it and its four neighbours are recorded in
  // both LF images, by its inverse variance: quantisation, and a share of the gradient. The
  // deviations of the ratios are those of the pixels from them. None if too few pixels count, or
  // all channels are dark.
  //   grid  the place as b shows it (PatchSeenBy())
  std::optional<ExposureSample> CompareWith(const ComparedImage& b, const PatchGrid& grid) const;

 private:
  const ComparedImage a_;
  const double scale_;  // radiance of one step of light
  const PatchGrid grid_;
  const PatchWindow window_;
};

}  // namespace lf
