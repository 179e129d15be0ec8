// SPDX-License-Identifier: Apache-2.0
// Reads depth maps and point clouds, as lffocus depth writes them, for the page of lfvisualizer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// The largest number of points of a file that the page shows.
inline constexpr size_t kMostDepthPoints = 500'000;

// The points of one file. Elements of a depth map whose depth is not known are no points.
struct DepthPoints {
  std::vector<std::array<float, 3>> places;  // relative to the origin, world units
  // R, G, B in sRGB, and the confidence: 255 stands for 1.
  std::vector<std::array<uint8_t, 4>> colours;
  size_t count_in_file = 0;    // points of the file, before it was thinned
  size_t unknown_count = 0;    // elements of a depth map whose depth is not known
  bool has_confidence = true;  // false: the file states none, and all confidences are 1
  bool has_colours = true;     // false: the file states none, and all points are grey
  // The camera that sees the points, relative to the origin; none if the file does not state it.
  std::optional<Vec3> centre;
  // Distance of neighbouring points divided by their distance from the camera, about. If there is
  // no camera, as if a camera with a view of 50 degrees saw all points of the file.
  double spread = 0;
};

// Reads the points of a file, which its extension names:
//   .exr  a depth map: channels Z (world units along the optical axis), R, G, B (linear light) and
//         confidence, and the attribute worldToNDC (doc/formats/frame.md). Z is not known where it
//         is infinite. Other files than those of lffocus depth may lack confidence, or R, G and B.
//   .ply  a point cloud, as ReadPlyPoints() reads it
// If a file has n points, and n is larger than `most`, one of each ceil(n / most) points in a row
// is kept, chosen at random: always the same one.
//   origin       what places are relative to, because floats would round places far from the
//                world's origin
//   unit_m       length of the world unit of the light field
// kInput: the file cannot be read, has another form, or has no point; its channels or attributes
// are missing; a depth is not a number or not above 0, a place is infinite, or a confidence is not
// from 0 to 1; its world unit is another one. kUsage: another
// extension.
Result<DepthPoints> ReadDepthPoints(const std::filesystem::path& file, const Vec3& origin,
                                    double unit_m, size_t most = kMostDepthPoints);

// Reads a PLY file of the format binary_little_endian 1.0 whose first element is `vertex`, with the
// scalar properties x, y, z (float or double; world units); red, green, blue (uchar, sRGB) and
// confidence (float or double, from 0 to 1), if there are some; and any others, in any order.
// Elements behind the vertices are ignored. Messages call the file `name`. Errors and thinning are
// those of ReadDepthPoints().
Result<DepthPoints> ReadPlyPoints(std::string_view bytes, const std::string& name,
                                  const Vec3& origin, double unit_m,
                                  size_t most = kMostDepthPoints);

// Encodes points for the page, little-endian: uint32 number of points n, then n times float x, y,
// z, then n times uint8 R, G, B, confidence.
std::string DepthBytes(const DepthPoints& points);

}  // namespace lf
