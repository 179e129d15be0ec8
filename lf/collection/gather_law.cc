#include "lf/collection/gather_law.h"

#include "lf/collection/gather.h"
#include "lf/collection/gather_sampling.h"

namespace lf {

GatherLaw::GatherLaw(const PinholeCamera& lf_camera, const RenderCamera& render_camera)
    : lf_camera_(lf_camera),
      render_camera_(render_camera),
      centre_(lf_camera.CentreWorld()),
      offset_(centre_ - render_camera.pinhole.CentreWorld()),
      forward_(render_camera.pinhole.ForwardWorld()),
      right_(render_camera.pinhole.RightWorld()),
      up_(render_camera.pinhole.UpWorld()),
      aperture_(render_camera.aperture),
      map_(lf_camera.intrinsics.distortion) {
  may_lack_rays_ = MayLackRays(lf_camera.intrinsics);
}

std::optional<Vec3> GatherLaw::Direction(int x, int y) const {
  // The focus point, before the lens.
  const std::optional<Vec3> focus_point = FocusPointOfElement(render_camera_, x + 0.5, y + 0.5);
  if (!focus_point) return std::nullopt;
  // The line through it and c, running forward.
  Vec3 d = *focus_point - centre_;
  if (forward_.dot(d) < 0) d = -d;
  if (!(forward_.dot(d) > 0)) return std::nullopt;
  const Vec3 on_lens = offset_ - d * (forward_.dot(offset_) / forward_.dot(d));
  if (!aperture_.Contains({right_.dot(on_lens), up_.dot(on_lens)})) return std::nullopt;
  return lf_camera_.cam_from_world.rotation * d;
}

std::optional<Vec2> GatherLaw::Position(int x, int y) const {
  const std::optional<Vec3> direction = Direction(x, y);
  if (!direction) return std::nullopt;
  const std::optional<Vec2> recorded = map_.Distort(*direction);
  if (!recorded) return std::nullopt;
  const Intrinsics& k = lf_camera_.intrinsics;
  const Vec2 p = (k.Matrix() * Vec3(recorded->x(), recorded->y(), 1)).head<2>();
  if (!HasFourPixels(k, p.x(), p.y())) return std::nullopt;
  if (may_lack_rays_ && !RaysArriveAround(k, map_, p.x(), p.y())) return std::nullopt;
  return p;
}

}  // namespace lf
