// One ray of the estimator *bilinear*, literally, in double precision (doc/ray.md, "What is
// added"): the reference asks it of every element, the fast kernel where its spans begin and end.
// Internal to collection.
#pragma once

#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/camera/ray_through.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"

namespace lf {

class GatherLaw {
 public:
  // render_camera  with the finer plate, where an element's ray is the mean of several
  GatherLaw(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

  // The direction, in the world, of the ray that element (x, y) asks for; none if it has no focus
  // point before the lens, or the ray misses the lens.
  std::optional<Vec3> Direction(int x, int y) const;

  // Where the LF camera records it, in pixels; none unless the four pixels around are in the image
  // and rays arrive there.
  std::optional<Vec2> Position(int x, int y) const;

  // Whether some pixels of the LF image have no ray: then each has to be asked.
  bool may_lack_rays() const { return may_lack_rays_; }

 private:
  RenderCamera render_camera_;
  Vec3 forward_, right_, up_;
  RayThrough ray_;
  Vec3 offset_;  // c - c'
  ApertureTest aperture_;
  bool may_lack_rays_ = false;
};

// Whether the four pixel centres around (x, y) are in the image.
inline bool HasFourPixels(const Intrinsics& k, double x_px, double y_px) {
  return x_px >= 0.5 && x_px < k.width_px - 0.5 && y_px >= 0.5 && y_px < k.height_px - 0.5;
}

}  // namespace lf
