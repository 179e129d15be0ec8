// SPDX-License-Identifier: Apache-2.0
// A world of textured walls, or of a disk with nothing around it, whose images are known exactly,
// for tests.
#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/test_value_noise.h"
#include "lf/densify/compared_tones.h"
#include "lf/densify/working_image.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

// A wall at z = depth, left of an edge. Cameras look along z.
struct Wall {
  double depth = 1;
  double edge = INFINITY;  // the wall ends at this x
  uint64_t seed = 1;
};

// Returns the wall that a camera sees at a pixel: the nearest that the ray meets.
inline const Wall* WallAt(const PinholeCamera& camera, const std::vector<Wall>& walls, double x_px,
                          double y_px, Vec3* point) {
  const Ray ray = RayOfPixel(camera, x_px, y_px);
  const Wall* seen = nullptr;
  for (const Wall& wall : walls) {
    const Vec3 at = ray.At((wall.depth - ray.origin.z()) / ray.direction.z());
    if (at.x() > wall.edge || (seen && seen->depth < wall.depth)) continue;
    seen = &wall;
    *point = at;
  }
  return seen;
}

// Returns what a camera records: radiance of 16 bits, and tones equal to its upper 8 bits.
inline WorkingImage ImageOfWalls(const PinholeCamera& camera, const std::vector<Wall>& walls) {
  constexpr double kPixelsPerDetail = 5;
  const Intrinsics& k = camera.intrinsics;
  WorkingImage image{camera, Image<uint16_t>(k.width_px, k.height_px, LfPixels::kRgbLanes),
                     Image<uint16_t>(k.width_px, k.height_px, LfPixels::kRgbLanes)};
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      Vec3 point;
      const Wall* wall = WallAt(camera, walls, x + 0.5, y + 0.5, &point);
      if (!wall) continue;
      const double scale = k.fx_px / wall->depth / kPixelsPerDetail;
      for (int c = 0; c < 3; ++c) {
        const double value = ValueNoise(point.x() * scale, point.y() * scale,
                                        wall->seed * 3 + static_cast<uint64_t>(c));
        image.light.at(x, y, c) = static_cast<uint16_t>(65535 * value);
        image.tones.at(x, y, c) = static_cast<uint16_t>(255 * value);
      }
      image.light.at(x, y, 3) = kOpaqueOpacity;
      image.tones.at(x, y, 3) = 255;
    }
  image.compared = ComparedTones(image.tones);
  image.without_depth = PixelsWithoutDepth(image.tones);
  return image;
}

// A disk at z = depth around x = y = 0, in front of nothing. Cameras look along z.
struct Disk {
  double depth = 2;
  double radius = 0.3;
  double brightness = 1;
  bool has_texture = true;
};

// Returns by how many pixels the centre of a pixel is inside the outline of the disk; below 0 if it
// is outside.
inline double InsidePx(const PinholeCamera& camera, const Disk& disk, int x, int y) {
  const Ray ray = RayOfPixel(camera, x + 0.5, y + 0.5);
  const Vec3 at = ray.At((disk.depth - ray.origin.z()) / ray.direction.z());
  return (disk.radius - at.head<2>().norm()) * camera.intrinsics.fx_px / disk.depth;
}

// Returns what a camera records. The outline is as soft as that of pixels that show areas.
inline WorkingImage ImageOfDisk(const PinholeCamera& camera, const Disk& disk) {
  constexpr double kPixelsPerDetail = 5;
  const Intrinsics& k = camera.intrinsics;
  WorkingImage image{camera, Image<uint16_t>(k.width_px, k.height_px, LfPixels::kRgbLanes),
                     Image<uint16_t>(k.width_px, k.height_px, LfPixels::kRgbLanes)};
  const double scale = k.fx_px / disk.depth / kPixelsPerDetail;
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      const double opacity = std::clamp(0.5 + InsidePx(camera, disk, x, y), 0.0, 1.0);
      const Ray ray = RayOfPixel(camera, x + 0.5, y + 0.5);
      const Vec3 at = ray.At((disk.depth - ray.origin.z()) / ray.direction.z());
      for (uint64_t c = 0; c < 3; ++c) {
        const double detail =
            disk.has_texture ? ValueNoise(at.x() * scale, at.y() * scale, 1 + c) : 1;
        const double value = opacity * disk.brightness * detail;
        image.light.at(x, y, static_cast<int>(c)) = static_cast<uint16_t>(65535 * value + 0.5);
        image.tones.at(x, y, static_cast<int>(c)) = static_cast<uint16_t>(255 * value + 0.5);
      }
      image.light.at(x, y, 3) = static_cast<uint16_t>(1.5 + kMostOpacity * opacity);
      image.tones.at(x, y, 3) =
          static_cast<uint16_t>(kTransparentTone + (255 - kTransparentTone) * opacity + 0.5);
    }
  image.compared = ComparedTones(image.tones);
  image.empty = EmptyPixels(image.tones);
  image.without_depth = PixelsWithoutDepth(image.tones);
  return image;
}

// Returns a camera at (x, y, 0) that looks along z.
inline PinholeCamera CameraAt(double x, double y, int width_px = 96, int height_px = 64) {
  PinholeCamera camera;
  camera.intrinsics = {100, 100, width_px / 2.0, height_px / 2.0, 0, width_px, height_px, {}, {}};
  camera.cam_from_world.translation = Vec3(-x, -y, 0);
  return camera;
}

// Calls check() for each instruction set.
template <class Check>
void ForEachTarget(const Check& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace lf
