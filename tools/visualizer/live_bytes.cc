// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/live_bytes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "lf/light_field/model/lf_pixels.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace {

std::string RawBytes(std::span<const uint16_t> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

Json RowsOf(const Mat3& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rows.push_back(matrix(row, column));
  return rows;
}

}  // namespace

std::string WhyNotInBrowser(const LightField& field) {
  if (field.encoding.HasOpacity()) return "the LF images have opacities";
  const bool is_bent = std::any_of(field.intrinsics.begin(), field.intrinsics.end(),
                                   [](const Intrinsics& k) { return k.has_distortion(); });
  return is_bent ? "the lenses of the LF cameras have distortion" : "";
}

std::string WithHead(const Json& json) {
  std::string text = RecordLine(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<uint32_t>(text.size());
  std::string bytes(sizeof(length), '\0');
  std::memcpy(bytes.data(), &length, sizeof(length));
  return bytes + text;
}

std::string LensBytes(const LiveRenderer::LensPlan& plan, const RenderCamera& frame, Json json) {
  const PictureLens& lens = plan.lens;
  const RadianceEncoding& encoding = plan.field.encoding;
  const Intrinsics& plate = frame.pinhole.intrinsics;
  json["refused"] = WhyNotInBrowser(plan.field);
  json["width"] = plate.width_px;
  json["height"] = plate.height_px;
  json["fx"] = plate.fx_px;
  json["fy"] = plate.fy_px;
  json["cx"] = plate.cx_px;
  json["cy"] = plate.cy_px;
  json["columns"] = lens.columns;
  json["rows"] = lens.rows;
  json["radius"] = lens.opening.radius_w;
  json["blades"] = lens.opening.blades;
  json["rotation"] = lens.opening.rotation_rad;
  json["ratio"] = lens.opening.ratio;
  json["roundness"] = lens.opening.roundness;
  json["feather"] = lens.has_feather;
  json["uncovered_share"] = lens.uncovered_share;
  json["camera_distance"] = lens.camera_distance_w;
  json["pedestal"] = encoding.pedestal;
  const Vec3 factors(encoding.white_balance[0], encoding.white_balance[1],
                     encoding.white_balance[2]);
  json["colours"] =
      RowsOf(encoding.linear_srgb_from_camera * Mat3(factors.asDiagonal()) / encoding.Scale());
  json["images"] = plan.ids.size();
  Json& images = json["lf_images"] = Json::array();
  for (const PictureLens::Image& image : lens.images)
    images.push_back(
        {plan.ids[image.index].value, image.blocks.shift_x, image.blocks.shift_y, image.samples});
  return WithHead(json) + RawBytes(lens.nodes);
}

Json LfCameraJson(const PinholeCamera& camera) {
  const Intrinsics& k = camera.intrinsics;
  const Vec3 centre = camera.CentreWorld();
  return {{"width", k.width_px},
          {"height", k.height_px},
          {"matrix", RowsOf(k.Matrix() * camera.cam_from_world.rotation)},
          {"centre", {centre.x(), centre.y(), centre.z()}}};
}

std::string LfImageBytes(const PinholeCamera& camera, const LfPixels& pixels) {
  return WithHead(LfCameraJson(camera)) + RawBytes(pixels.radiance.pixels());
}

}  // namespace lf
