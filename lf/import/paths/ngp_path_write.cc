// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <array>

#include "lf/import/paths/lf_camera_keys.h"
#include "lf/import/paths/ngp_path.h"
#include "lf/light_field/transforms_json/json_text.h"

namespace lf {
namespace {

// Adds a keyframe. instant-ngp focuses at slice + scale, where scale is by default 1.5 and is the
// distance of the point about which its mouse turns.
void AddNgpKey(const RenderCamera& camera, const NgpSpace& space, double timestamp, JsonText* out) {
  const RigidTransform ngp_from_cam =
      PoseIn(NgpFromWorld(space), camera.pinhole.cam_from_world).Inverse();
  const Eigen::Quaterniond q(ngp_from_cam.rotation);
  out->Add("{{\"R\": ");
  out->AddNumbers(std::array{q.x(), q.y(), q.z(), q.w()});
  out->Add(", \"T\": ");
  out->AddNumbers({ngp_from_cam.translation.data(), 3});
  out->Add(", \"slice\": 0, \"scale\": {}, \"fov\": {}, \"aperture_size\": {}, \"timestamp\": {}",
           camera.focus_distance_w * space.scale, VerticalFov_deg(camera.pinhole.intrinsics),
           camera.aperture.radius_w * space.scale, timestamp);
  AddLfCameraKeys(camera, out);
  out->Add("}}");
}

}  // namespace

std::string NgpText(const CameraPath& path, const NgpSpace& space) {
  const Intrinsics& plate = path.cameras.front().pinhole.intrinsics;
  const size_t count = path.frame_count();
  JsonText out;
  out.Add(
      "{{\n\"loop\": false,\n\"time\": 0,\n\"spline_order\": 1,\n\"duration_seconds\": {},\n"
      "\"lf_fps\": {},\n\"lf_frames\": {},\n\"lf_resolution\": [{}, {}],\n\"lf_unit_m\": {},\n"
      "\"lf_scale\": {},\n\"lf_offset\": ",
      static_cast<double>(count) / path.fps, path.fps, count, plate.width_px, plate.height_px,
      path.unit_m, space.scale);
  out.AddNumbers({space.offset.data(), 3});
  if (path.views > 1) out.Add(",\n\"lf_views\": {}", path.views);
  if (path.first_frame != 1) out.Add(",\n\"lf_first_frame\": {}", path.first_frame);
  // The last camera is written twice, because instant-ngp films n frames at the shares 0, 1/n, ...,
  // (n - 1)/n of the time between the first and the last keyframe. A timestamp is the end of the
  // segment that begins at its keyframe.
  out.Add(",\n\"path\": [");
  for (size_t i = 0; i <= count; ++i) {
    out.Add("{}\n", i > 0 ? "," : "");
    AddNgpKey(path.cameras[std::min(i, count - 1)], space,
              static_cast<double>(i + 1) / static_cast<double>(count + 1), &out);
  }
  out.Add("\n]\n}}\n");
  return out.text();
}

}  // namespace lf
