// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/gather_model.h"

#include "lf/collection/gather.h"
#include "lf/collection/gather_sampling.h"

namespace lf {

GatherModel::GatherModel(const PinholeCamera& lf_camera, const RenderCamera& render_camera)
    : render_camera_(render_camera),
      forward_(render_camera.pinhole.ForwardWorld()),
      right_(render_camera.pinhole.RightWorld()),
      up_(render_camera.pinhole.UpWorld()),
      ray_(lf_camera, forward_),
      offset_(ray_.centre_world() - render_camera.pinhole.CentreWorld()),
      aperture_(render_camera.aperture),
      hood_(render_camera),
      may_lack_rays_(MayLackRays(lf_camera.intrinsics)) {}

std::optional<Vec3> GatherModel::Direction(int x, int y) const {
  // The element's focus point; nullopt if it is not in front of the lens.
  const std::optional<Vec3> focus_point = FocusPointOfElement(render_camera_, x + 0.5, y + 0.5);
  if (!focus_point) return std::nullopt;
  const Vec3 d = ray_.DirectionWorld(*focus_point);
  if (!(forward_.dot(d) > 0)) return std::nullopt;
  const Vec3 on_lens = offset_ - d * (forward_.dot(offset_) / forward_.dot(d));
  if (!aperture_.Contains({right_.dot(on_lens), up_.dot(on_lens)})) return std::nullopt;
  if (!hood_.LetsThrough(*focus_point, d)) return std::nullopt;
  return d;
}

std::optional<Vec2> GatherModel::Position(int x, int y) const {
  const std::optional<Vec3> direction = Direction(x, y);
  if (!direction) return std::nullopt;
  const std::optional<Vec2> p = ray_.RecordedAt(*direction);
  const Intrinsics& k = ray_.intrinsics();
  if (!p || !HasFourPixels(k, p->x(), p->y())) return std::nullopt;
  if (may_lack_rays_ && !RaysArriveAround(k, ray_.map(), p->x(), p->y())) return std::nullopt;
  return p;
}

}  // namespace lf
