// The feather of an LF image: its rays count less and less towards its borders (doc/ray.md, "What
// is added"), so that a frame shows no seam where an image ends that is brighter than its
// neighbours.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// Width of the feathered border, as a part of the image's shorter side.
inline constexpr double kFeatherShare = 1.0 / 32;

// Returns the feather, in [0, 1], of a ray that the LF image records at position (x, y). It is 0 at
// the centres of the outermost pixels and beyond, 1 at a distance of kFeatherShare of the shorter
// side and more from them, and smooth in between. In corners, it is the product of both directions.
double FeatherAt(const Intrinsics& lf_image, double x_px, double y_px);

// The feather of one LF image all over the plate of one frame.
class ImageFeather {
 public:
  ImageFeather(const PinholeCamera& lf_camera, const RenderCamera& frame);

  // Writes the feather, in 1/kWholeFeather, at the positions (x + kWeightBlock i, y) of the plate,
  // i in [0, count); 0 if the LF camera records no ray through the focus point. May be called by
  // several threads at the same time. Takes about 10 ns for each position, 50 ns with lens
  // distortion.
  void OfRow(int x, int y, int count, uint16_t* feather) const;

 private:
  double At(const Vec3& direction) const;

  Intrinsics intrinsics_;
  // Linear forms on positions e = (x, y, 1) of the plate. X is the focus point of the position, c
  // the centre of the LF camera.
  Mat3 to_focus_;      // X - c in axes of the LF camera, times a positive factor
  Vec3 before_lens_;   // > 0 if X is in front of the lens
  Vec3 runs_forward_;  // > 0 if X - c runs forward; otherwise c - X does
  mutable std::once_flag map_is_made_;
  mutable std::optional<DistortionMap> map_;  // made when first needed, because it takes a while
};

}  // namespace lf
