// SPDX-License-Identifier: Apache-2.0
// The text of a short valid path for tests, whose parts can be replaced.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "lf/camera/path/path_yaml.h"

namespace lf {

struct TestPath {
  std::string clock = "fps: 10\nframes: 21\nresolution: [200, 100]\n";
  std::string pose = "position: [0, 0, -2], look_at: [0, 0, 0]";
  std::string optics = "sensor_width_mm: 36, focal_length_mm: 50";
  std::string aperture = "aperture_diameter_mm: 4";
  std::string focus = "focus_distance: 2";
  std::string more = "";  // text after the sections

  std::string Text() const {
    return "format: lfpath 1\n" + clock + "camera: {" + pose + ", " + optics + "}\nlens: {" +
           aperture + ", " + focus + "}\n" + more;
  }
  Result<CameraPath> Parse(std::optional<double> light_field_unit_m = std::nullopt) const {
    return ParsePathYaml(Text(), "p.yaml", light_field_unit_m);
  }
  // Returns the error message of Parse() without the file's name; "" if there is no error.
  std::string Error() const {
    const auto path = Parse();
    return path ? "" : path.error().message.substr(std::string("p.yaml:").size());
  }
  // Returns the camera of a frame; frame i is at (i - 1) / 10 seconds.
  RenderCamera At(uint32_t frame) const {
    const auto path = Parse();
    if (!path) ADD_FAILURE() << path.error().message;
    return path ? path->Camera({frame}) : RenderCamera{};
  }
};

}  // namespace lf
