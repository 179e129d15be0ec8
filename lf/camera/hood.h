// SPDX-License-Identifier: Apache-2.0
// A round frame in front of the lens, such as the rim of a long lens's front element. It cuts off
// oblique rays, so that blurred lights towards the corners of the picture have the shape of a cat's
// eye.
#pragma once

#include <vector>

#include "lf/camera/aperture.h"
#include "lf/camera/render_camera.h"

namespace lf {

// Returns the edges of the hood's opening around the optical axis, in lens coordinates: a polygon
// of kHoodEdges edges with the area of the disk. Empty if there is no hood.
inline constexpr int kHoodEdges = 24;
std::vector<ApertureEdge> Edges(const Hood& hood);

// Returns the edges, in lens coordinates, of the part of the lens plane through which the hood lets
// rays pass that meet at a point of the focus plane. Empty if there is no hood.
//   focus_world  not in the plane of the lens
std::vector<ApertureEdge> HoodOnLens(const RenderCamera& camera, const Vec3& focus_world);

// Tests rays against the hood. Rays are lines: the hood cuts them off wherever the LF camera and
// the focus point are along them.
class HoodTest {
 public:
  explicit HoodTest(const RenderCamera& camera);
  bool exists() const { return !edges_.empty(); }
  // Returns true if there is no hood, or if the line lets through.
  //   point      any point of the line, in the world
  //   direction  its direction; not parallel to the plane of the lens
  bool LetsThrough(const Vec3& point_world, const Vec3& direction_world) const;

 private:
  std::vector<ApertureEdge> edges_;
  Vec3 centre_ = Vec3::Zero();  // centre of the hood's opening, in the world
  Vec3 right_ = Vec3::UnitX(), up_ = Vec3::UnitY(), forward_ = Vec3::UnitZ();
};

}  // namespace lf
