// The ray model for one ray, applied literally: doc/ray.md, "Geometry" 1-5, in double precision.
// The reference asks it for every pixel, the fast kernels at the ends of their spans.
#pragma once

#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/plate/tile_grid.h"

namespace lf {

// True if the LF camera stands in the lens plane, to rounding. All its rays then cross the lens at
// one point (doc/ray.md, Geometry 6).
bool LiesInLensPlane(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// True if that point is so far inside a disk that rounding cannot move it out.
bool IsSurelyInDisk(const PinholeCamera& lf_camera_in_lens_plane,
                    const RenderCamera& render_camera);

// Decides which rays of one LF camera a render camera accepts, and where they land.
class RayModel {
 public:
  RayModel(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

  // Returns the element of the plate on which the ray of LF pixel (x, y) lands; none if the ray is
  // not accepted because it runs backward, has no focus point before the lens, or misses the lens
  // or the plate. Lens distortion is undone by iteration.
  std::optional<PlateElement> Collect(int x, int y) const;

  // As Collect(), for an ideal position (camera/ideal_pixels.h).
  std::optional<PlateElement> CollectIdeal(const Vec3& position) const;

 private:
  Intrinsics intrinsics_;
  std::optional<DistortionMap> distortion_;
  Vec3 centre_;       // c
  Mat3 direction_;    // R^T K^-1
  Vec3 lens_centre_;  // c'
  Vec3 right_, up_, forward_;
  Plane focus_plane_;
  Mat3 plate_from_world_;  // K' R', after subtracting c'
  ApertureTest aperture_;
  int width_px_, height_px_;
};

}  // namespace lf
