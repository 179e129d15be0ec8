// How the rays of an LF image count less and less towards its borders (doc/ray.md, "What is
// added"), so that a frame shows no seam where an image ends that is brighter than its neighbours.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

// The border that is feathered is this part of the image's shorter side.
inline constexpr double kFeatherShare = 1.0 / 32;

// The feather, in [0, 1], of a ray that the LF image records at position (x, y): 0 on the centres
// of its outermost pixels and beyond, 1 where it is at least kFeatherShare of the shorter side away
// from them, smoothly between; in corners the product of both directions.
double FeatherAt(const Intrinsics& lf_image, double x_px, double y_px);

// The feather of one LF image all over the plate of one frame.
class ImageFeather {
 public:
  ImageFeather(const PinholeCamera& lf_camera, const RenderCamera& frame);

  // In 1/kWholeFeather, at the positions (x + kWeightBlock i, y) of the plate, i in [0, count); 0
  // where the LF camera records no ray through the focus point. Any thread may call it.
  // About 10 ns each, with lens distortion 50.
  void OfRow(int x, int y, int count, uint16_t* feather) const;

 private:
  double At(const Vec3& direction) const;

  Intrinsics intrinsics_;
  // Linear forms on positions e = (x, y, 1) of the plate. X is the point of the focus plane seen
  // there, c the LF camera.
  Mat3 to_focus_;      // X - c in axes of the LF camera, times something positive
  Vec3 before_lens_;   // > 0 where X is before the lens
  Vec3 runs_forward_;  // > 0 where X - c runs forward, else c - X does
  mutable std::once_flag map_is_made_;
  mutable std::optional<DistortionMap> map_;  // with lens distortion; it takes a while to make
};

}  // namespace lf
