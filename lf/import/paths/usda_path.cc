// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/usda_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "lf/camera/thin_lens.h"
#include "lf/light_field/transforms_json/opengl_pose.h"

namespace lf {
namespace {

constexpr double kTenthsPerUnit = 10;

// Adds an attribute: one value if it is the same in all frames, otherwise one for each frame.
void AddAttribute(const char* type_and_name, const CameraPath& path,
                  const std::function<std::string(const RenderCamera&)>& value_of,
                  std::string* text) {
  std::vector<std::string> values;
  for (const RenderCamera& camera : path.cameras) values.push_back(value_of(camera));
  if (std::all_of(values.begin(), values.end(),
                  [&](const std::string& value) { return value == values[0]; })) {
    *text += fmt::format("    {} = {}\n", type_and_name, values[0]);
    return;
  }
  *text += fmt::format("    {}.timeSamples = {{\n", type_and_name);
  for (size_t i = 0; i < values.size(); ++i)
    *text += fmt::format("        {}: {},\n", path.frames().At(i).value, values[i]);
  *text += "    }\n";
}

void AddNumber(const char* name, const CameraPath& path, double (*value_of)(const RenderCamera&),
               std::string* text) {
  AddAttribute(
      fmt::format("float {}", name).c_str(), path,
      [&](const RenderCamera& camera) { return fmt::format("{}", value_of(camera) + 0.0); }, text);
}

// Returns the matrix of the camera's pose. USD multiplies rows from the left: the rows are the axes
// right, up, backward, and the position.
std::string MatrixText(const RenderCamera& camera) {
  const Mat34 pose = OpenGlOfCamFromWorld(camera.pinhole.cam_from_world);
  std::string text = "( ";
  for (int column = 0; column < 4; ++column)
    text += fmt::format("({}, {}, {}, {}){}", pose(0, column) + 0.0, pose(1, column) + 0.0,
                        pose(2, column) + 0.0, column == 3 ? 1 : 0, column == 3 ? " )" : ", ");
  return text;
}

// Lengths of the sensor plate per element, in tenths of a world unit.
double ElementWidth(const RenderCamera& c) {
  return kTenthsPerUnit * c.focal_length_w / c.pinhole.intrinsics.fx_px;
}
double ElementHeight(const RenderCamera& c) {
  return kTenthsPerUnit * c.focal_length_w / c.pinhole.intrinsics.fy_px;
}

void AddOptics(const CameraPath& path, std::string* text) {
  AddNumber(
      "focalLength", path, [](const RenderCamera& c) { return kTenthsPerUnit * c.focal_length_w; },
      text);
  AddNumber(
      "horizontalAperture", path,
      [](const RenderCamera& c) { return c.pinhole.intrinsics.width_px * ElementWidth(c); }, text);
  AddNumber(
      "verticalAperture", path,
      [](const RenderCamera& c) { return c.pinhole.intrinsics.height_px * ElementHeight(c); },
      text);
  // The offsets move the window that is seen to the right and up.
  AddNumber(
      "horizontalApertureOffset", path,
      [](const RenderCamera& c) {
        return (c.pinhole.intrinsics.width_px / 2.0 - c.pinhole.intrinsics.cx_px) * ElementWidth(c);
      },
      text);
  AddNumber(
      "verticalApertureOffset", path,
      [](const RenderCamera& c) {
        return (c.pinhole.intrinsics.cy_px - c.pinhole.intrinsics.height_px / 2.0) *
               ElementHeight(c);
      },
      text);
  AddNumber(
      "focusDistance", path, [](const RenderCamera& c) { return c.focus_distance_w; }, text);
  // 0 means a pinhole.
  AddNumber(
      "fStop", path,
      [](const RenderCamera& c) {
        const double radius_w = c.aperture.radius_w;
        return radius_w > 0 ? FNumber(c.focal_length_w, 2 * radius_w) : 0;
      },
      text);
}

}  // namespace

std::string UsdaText(const CameraPath& path) {
  double nearest_w = path.cameras[0].focus_distance_w, farthest_w = nearest_w;
  for (const RenderCamera& camera : path.cameras) {
    nearest_w = std::min(nearest_w, camera.focus_distance_w);
    farthest_w = std::max(farthest_w, camera.focus_distance_w);
  }
  std::string text = fmt::format(
      "{}    startTimeCode = {}\n    endTimeCode = {}\n"
      "    timeCodesPerSecond = {}\n    framesPerSecond = {}\n    metersPerUnit = {}\n"
      "    upAxis = \"Y\"\n)\n\ndef Camera \"camera\"\n{{\n"
      "    token projection = \"perspective\"\n    float2 clippingRange = ({}, {})\n",
      kUsdaStart, path.first_frame, path.frames().last(), path.fps, path.fps, path.unit_m,
      nearest_w / 100, farthest_w * 100);
  AddOptics(path, &text);
  AddAttribute("matrix4d xformOp:transform", path, MatrixText, &text);
  text += "    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n}\n";
  return text;
}

}  // namespace lf
