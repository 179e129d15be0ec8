// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/around_lens.h"

#include <algorithm>
#include <optional>

#include "lf/light_field/model/time_slices.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

std::vector<LfImageId> CamerasAroundLens(const ImageIndex& index, const RenderCamera& frame,
                                         bool recorded_only) {
  const Intrinsics& k = frame.pinhole.intrinsics;
  const std::optional<Vec3> focus = FocusPointOfElement(frame, 0.5 * k.width_px, 0.5 * k.height_px);
  if (!focus) return {};
  RenderCamera middle = FocusedAsAt(frame, 0.5 * k.width_px, 0.5 * k.height_px);
  middle.pinhole.intrinsics.cx_px -= 0.5 * k.width_px;
  middle.pinhole.intrinsics.cy_px -= 0.5 * k.height_px;
  middle.pinhole.intrinsics.width_px = middle.pinhole.intrinsics.height_px = 0;
  const CameraTree& tree = index.tree();
  const LensPlane plane(frame);
  const SliceOfFrame slice(index.light_field(), frame.recording_time);
  // The radius of the lens that is searched begins with the larger of the lens radius and a
  // thousandth of the distance to the focus point. It doubles up to 29 times.
  constexpr int kDoublings = 30;
  double radius_w =
      std::max(frame.aperture.radius_w, 1e-3 * (*focus - frame.pinhole.CentreWorld()).norm());
  std::vector<LfImageId> ids;
  for (int i = 0; i < kDoublings; ++i, radius_w *= 2) {
    OpenUpTo(radius_w, &middle);
    ids.clear();
    size_t count = 0;
    tree.ForEachLeaf(SeenRegion(middle), [&](size_t leaf, bool /*all_inside*/) {
      for (const LfImageId id : tree.Leaf(leaf)) {
        if (!slice.Holds(id)) continue;
        if (recorded_only && index.light_field().cameras[id.value].is_virtual) continue;
        const Vec3 centre_world = index.light_field().Camera(id).CentreWorld();
        ids.push_back(id);
        count += plane.PointOfLine(centre_world, *focus).norm() <= radius_w;
      }
    });
    if (count >= kCamerasAround) break;
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

double CameraDistanceAround(const ImageIndex& index, const RenderCamera& frame) {
  std::vector<Vec3> centres_world;
  for (const LfImageId id : CamerasAroundLens(index, frame))
    centres_world.push_back(index.light_field().Camera(id).CentreWorld());
  if (index.light_field().encoding.masks_clipped) centres_world = DistinctPlaces(centres_world);
  return CameraDistance(frame, centres_world);
}

std::optional<Vec2> SeenAt(const RayThrough& lf_camera, const Vec3& point_world) {
  const std::optional<Vec2> p = lf_camera.RecordedAt(lf_camera.DirectionWorld(point_world));
  const Intrinsics& k = lf_camera.intrinsics();
  const bool is_inside =
      p && p->x() >= 0 && p->x() <= k.width_px && p->y() >= 0 && p->y() <= k.height_px;
  return is_inside ? p : std::nullopt;
}

}  // namespace lf
