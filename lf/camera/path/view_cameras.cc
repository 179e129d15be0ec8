// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/view_cameras.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

namespace lf {
namespace {

// Returns the offset of a view to the right, in world units, for a distance of convergence.
using OffsetOfView = std::function<double(int view, double convergence_w)>;

Result<CameraPath> PathOfViews(const CameraPath& path, int view_count,
                               std::optional<double> convergence_w, const OffsetOfView& offset_of) {
  if (path.frame_count() * static_cast<size_t>(view_count) > kMostFrames)
    return InputError(fmt::format(
        "{} views of {} frames are {} cameras: expected at most {}", view_count, path.frame_count(),
        path.frame_count() * static_cast<size_t>(view_count), kMostFrames));
  if (path.views > 1)
    return InputError(
        fmt::format("the path has {} views of each moment already: make the views of the path that "
                    "it was made of",
                    path.views));
  if (path.shutter.exists())
    return InputError(
        "the path has a shutter, but a path of views has none, because its cameras jump from view "
        "to view: remove the shutter from the path");
  if (path.focal_surface && path.focal_surface->kind == FocalSurfaceSource::Kind::kDepths)
    return InputError(
        "the path has a depth picture as its focal surface, which is seen from the camera of one "
        "frame, not from those of its views: use a height map (focus.kind: height), or remove "
        "'focus' from the path");
  CameraPath views;
  views.focal_surface = path.focal_surface;
  views.fps = path.fps;
  views.unit_m = path.unit_m;
  views.views = view_count;
  views.first_frame = path.first_frame;
  views.cameras.reserve(path.frame_count() * static_cast<size_t>(view_count));
  for (size_t frame = 0; frame < path.frame_count(); ++frame) {
    const RenderCamera& camera = path.cameras[frame];
    const double c_w = convergence_w.value_or(camera.focus_distance_w);
    for (int view = 0; view < view_count; ++view) {
      Result<RenderCamera> moved = MovedAside(camera, offset_of(view, c_w), c_w);
      if (!moved)
        return InputError(fmt::format("frame {}, view {}: {}", path.frames().At(frame).value,
                                      view + 1, moved.error().message));
      moved->time_s = static_cast<double>(views.frame_count()) / path.fps;
      views.cameras.push_back(*std::move(moved));
    }
  }
  return views;
}

}  // namespace

Result<RenderCamera> MovedAside(const RenderCamera& camera, double offset_w, double convergence_w) {
  LF_CHECK(convergence_w > 0);
  RenderCamera moved = camera;
  // The pose cam_from_world = [R t] of the centre c + offset R^T e_x has the translation
  // -R c - offset e_x.
  moved.pinhole.cam_from_world.translation.x() -= offset_w;
  moved.pinhole.intrinsics.cx_px += camera.pinhole.intrinsics.fx_px * offset_w / convergence_w;
  moved.focus_distance_w += offset_w * std::tan(camera.focus_tilt.horizontal_rad);
  if (!(moved.focus_distance_w > 0))
    return InputError(
        fmt::format("the camera is moved aside by {:.6g} world units, where the tilted focus plane "
                    "is {:.6g} world units in front of the lens: expected above 0; reduce the "
                    "tilt, or the distance of the views",
                    offset_w, moved.focus_distance_w));
  moved.focus_plane = FocusPlane(moved.pinhole, moved.focus_distance_w, moved.focus_tilt);
  return moved;
}

Result<CameraPath> StereoPath(const CameraPath& path, double separation_w,
                              std::optional<double> convergence_w) {
  LF_CHECK(separation_w > 0);
  return PathOfViews(path, 2, convergence_w,
                     [separation_w](int view, double) { return (view - 0.5) * separation_w; });
}

Result<CameraPath> QuiltPath(const CameraPath& path, int view_count, double view_angle_rad,
                             std::optional<double> convergence_w) {
  LF_CHECK(view_count >= 2 && view_angle_rad > 0 && view_angle_rad < kPi);
  const double width_per_distance = 2 * std::tan(view_angle_rad / 2);
  return PathOfViews(path, view_count, convergence_w, [=](int view, double c_w) {
    const double share = static_cast<double>(view) / (view_count - 1) - 0.5;
    return share * width_per_distance * c_w;
  });
}

}  // namespace lf
