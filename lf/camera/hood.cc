// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/hood.h"

#include <algorithm>
#include <cmath>

namespace lf {

std::vector<ApertureEdge> Edges(const Hood& hood) {
  std::vector<ApertureEdge> edges;
  if (!hood.exists()) return edges;
  constexpr double kStep = 2 * kPi / kHoodEdges;
  // The apothem of the regular polygon that has the area of the disk.
  const double apothem_w = hood.radius_w * std::sqrt(kStep / 2 / std::tan(kStep / 2));
  for (int i = 0; i < kHoodEdges; ++i)
    edges.push_back({{std::cos(i * kStep), std::sin(i * kStep)}, apothem_w});
  return edges;
}

std::vector<ApertureEdge> HoodOnLens(const RenderCamera& camera, const Vec3& focus_world) {
  std::vector<ApertureEdge> edges = Edges(camera.hood);
  const Vec3 offset = focus_world - camera.pinhole.CentreWorld();
  const double depth_w = camera.pinhole.ForwardWorld().dot(offset);
  const Vec2 beside_w(camera.pinhole.RightWorld().dot(offset),
                      camera.pinhole.UpWorld().dot(offset));
  // A ray from the lens point l to the focus point, at depth z and beside_w from the axis, meets
  // the plane of the hood, at depth D, at  beside_w D / z + l (1 - D / z).
  const double share = camera.hood.distance_w / depth_w;
  constexpr double kLeast = 1e-12;
  const double left = std::max(kLeast, std::abs(1 - share));
  const double sign = share > 1 ? -1 : 1;
  for (ApertureEdge& edge : edges)
    edge = {sign * edge.normal, (edge.distance_w - share * edge.normal.dot(beside_w)) / left};
  return edges;
}

HoodTest::HoodTest(const RenderCamera& camera)
    : edges_(Edges(camera.hood)),
      centre_(camera.pinhole.CentreWorld() +
              camera.hood.distance_w * camera.pinhole.ForwardWorld()),
      right_(camera.pinhole.RightWorld()),
      up_(camera.pinhole.UpWorld()),
      forward_(camera.pinhole.ForwardWorld()) {}

bool HoodTest::LetsThrough(const Vec3& point_world, const Vec3& direction_world) const {
  if (edges_.empty()) return true;
  const Vec3 offset = point_world - centre_;
  const Vec3 there =
      offset - direction_world * (forward_.dot(offset) / forward_.dot(direction_world));
  const Vec2 at(right_.dot(there), up_.dot(there));
  return std::all_of(edges_.begin(), edges_.end(), [&](const ApertureEdge& edge) {
    return edge.normal.dot(at) <= edge.distance_w * (1 + kRimTolerance / 2);
  });
}

}  // namespace lf
