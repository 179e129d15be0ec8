// SPDX-License-Identifier: Apache-2.0
// The ray model for one ray, applied literally: doc/ray.md, "Geometry" 1-5, in double precision.
// ScatterReference() applies it to every pixel, PlanScatter() only to pixels about which rounding
// might decide.
#pragma once

#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/hood.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/film/plate/tile_grid.h"

namespace lf {

// True if the LF camera lies in the lens plane, except for rounding errors. All its rays then meet
// the lens plane at one point, the position of the camera (doc/ray.md, Geometry 6).
bool LiesInLensPlane(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// True if the LF camera, which must lie in the lens plane, is so far inside the aperture, which
// must be a disk, that rounding errors cannot move it out.
bool IsSurelyInDisk(const PinholeCamera& lf_camera_in_lens_plane,
                    const RenderCamera& render_camera);

// Decides which rays of one LF camera a render camera accepts, and where they land.
class RayModel {
 public:
  RayModel(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

  // Returns the element of the plate on which the ray of LF pixel (x, y) lands; none if the pixel
  // has no ray because it lies beyond the fold of the lens distortion, or if the ray is not
  // accepted because it runs backward, has no focus point in front of the lens, or misses the lens
  // or the plate. Lens distortion is undone by iteration.
  std::optional<PlateElement> Collect(int x, int y) const;

  // Like Collect(), for the ray of an ideal position (camera/ideal_pixels.h).
  std::optional<PlateElement> CollectIdeal(const Vec3& position) const;

 private:
  Intrinsics intrinsics_;
  std::optional<DistortionMap> distortion_;
  Vec3 centre_;       // position of the LF camera in the world: c of doc/ray.md
  Mat3 direction_;    // maps an ideal position to the direction of its ray: R^T K^-1 of doc/ray.md
  Vec3 lens_centre_;  // centre of the lens in the world: c' of doc/ray.md
  Vec3 right_, up_, forward_;
  Plane focus_plane_;
  Mat3 plate_from_world_;  // K' R' of doc/ray.md: maps X - c' to the plate, for a focus point X
  ApertureTest aperture_;
  HoodTest hood_;
  PixelRect elements_;  // the elements that take rays: those of the plate, or of the window
};

}  // namespace lf
