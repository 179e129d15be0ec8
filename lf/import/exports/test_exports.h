// SPDX-License-Identifier: Apache-2.0
// Functions that the tests of several readers of exports share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Expects an error of bad input whose message begins with "f/" and contains `part`.
template <class T>
void ExpectFault(const Result<T>& result, const std::string& part) {
  ASSERT_FALSE(result) << "expected: " << part;
  EXPECT_EQ(result.error().kind, ErrorKind::kInput);
  EXPECT_TRUE(result.error().message.starts_with("f/")) << result.error().message;
  EXPECT_NE(result.error().message.find(part), std::string::npos)
      << part << "\nnot in: " << result.error().message;
}

// Returns `text` with the first `from` replaced by `to`.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Returns the position of a point in an image.
inline Vec2 PixelOf(const ExportedImage& image, const Vec3& point_world) {
  const Intrinsics& k = image.intrinsics;
  const std::optional<Vec2> distorted =
      DistortionMap(k.distortion).Distort(image.cam_from_world * point_world);
  EXPECT_TRUE(distorted.has_value());
  if (!distorted) return Vec2::Zero();
  return {k.fx_px * distorted->x() + k.skew_px * distorted->y() + k.cx_px,
          k.fy_px * distorted->y() + k.cy_px};
}

inline void ExpectNear(const Vec2& found, const Vec2& expected) {
  EXPECT_NEAR(found.x(), expected.x(), 1e-9);
  EXPECT_NEAR(found.y(), expected.y(), 1e-9);
}

}  // namespace lf
