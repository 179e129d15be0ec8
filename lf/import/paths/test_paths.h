// SPDX-License-Identifier: Apache-2.0
// Texts of foreign camera paths for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Expects the error of `result` to begin with the file's name and to contain each part.
template <class T>
void ExpectPathError(const Result<T>& result, const std::string& file,
                     const std::vector<std::string>& parts) {
  ASSERT_FALSE(result) << file;
  const std::string& message = result.error().message;
  EXPECT_EQ(message.find(file + ": "), 0u) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << "\nnot in: " << message;
}

// Returns `text` with the first `from` replaced by `to`.
inline std::string With(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A camera at (1, 2, 3) that looks along +y of the world, with z up: OpenGL's axes x, y, z are x, z
// and -y of the world.
inline const std::string kNerfstudioText = R"({"camera_type": "perspective", "render_width": 200,
"render_height": 100, "fps": 10, "seconds": 0.1, "keyframes": [{"matrix": "[1]"}],
"camera_path": [{"camera_to_world": [1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1],
                 "fov": 90, "aspect": 2}]})";

// A base_cam.json of that camera, with the focus at 4 / 0.33 world units.
inline const std::string kNgpText =
    R"({"path": [{"R": [0.7071067811865476, 0, 0.7071067811865476, 0],
"T": [1.16, 1.49, 0.83],
"slice": 1, "scale": 3, "fov": 90, "aperture_size": 0.033}], "spline_order": 3, "loop": false})";

}  // namespace lf
