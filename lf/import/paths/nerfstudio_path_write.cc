// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "lf/import/paths/lf_camera_keys.h"
#include "lf/import/paths/nerfstudio_path.h"
#include "lf/light_field/transforms_json/json_text.h"
#include "lf/light_field/transforms_json/opengl_pose.h"

namespace lf {
namespace {

void AddNerfstudioFrame(const RenderCamera& camera, JsonText* out) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = Eigen::Matrix4d::Identity();
  matrix.topRows<3>() = OpenGlOfCamFromWorld(camera.pinhole.cam_from_world);
  const Intrinsics& k = camera.pinhole.intrinsics;
  out->Add("{{\"camera_to_world\": ");
  out->AddNumbers({matrix.data(), 16});
  out->Add(", \"fov\": {}, \"aspect\": {}", VerticalFov_deg(k),
           static_cast<double>(k.width_px) / k.height_px);
  AddLfCameraKeys(camera, out);
  out->Add("}}");
}

}  // namespace

std::string NerfstudioText(const CameraPath& path, std::string_view space) {
  const Intrinsics& plate = path.cameras.front().pinhole.intrinsics;
  JsonText out;
  out.Add(
      "{{\n\"camera_type\": \"perspective\",\n\"render_width\": {},\n\"render_height\": {},\n"
      "\"fps\": {},\n\"seconds\": {},\n\"is_cycle\": false,\n\"smoothness_value\": 0,\n"
      "\"default_fov\": {},\n\"lf_space\": \"{}\",\n\"lf_unit_m\": {},\n",
      plate.width_px, plate.height_px, path.fps, static_cast<double>(path.frame_count()) / path.fps,
      VerticalFov_deg(plate), space, path.unit_m);
  if (path.views > 1) out.Add("\"lf_views\": {},\n", path.views);
  if (path.first_frame != 1) out.Add("\"lf_first_frame\": {},\n", path.first_frame);
  out.Add("\"keyframes\": [],\n\"camera_path\": [");
  for (size_t i = 0; i < path.frame_count(); ++i) {
    out.Add("{}\n", i > 0 ? "," : "");
    AddNerfstudioFrame(path.cameras[i], &out);
  }
  out.Add("\n]\n}}\n");
  return out.text();
}

}  // namespace lf
