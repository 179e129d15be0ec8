// Balls side by side, eight to a block, to find quickly the few that a ray comes near. For the
// hundred balls of a scene this beats a tree: no branch until a block has one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

// The points nearer to the axis than base_w / cos + along tan, of a half-line from `origin` along
// `direction` (unit length); sine = sin of half the opening angle.
struct Cone {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();
  double base_w = 0;
  double sine = 0;
};

class BallBlocks {
 public:
  void Add(const Vec3& centre_world, double radius_w) {
    const auto lane = static_cast<Eigen::Index>(count_++ % kLanes);
    if (lane == 0) blocks_.emplace_back();
    Block& block = blocks_.back();
    block.x[lane] = static_cast<float>(centre_world.x());
    block.y[lane] = static_cast<float>(centre_world.y());
    block.z[lane] = static_cast<float>(centre_world.z());
    block.radius[lane] = static_cast<float>(radius_w);
  }

  // Calls visit(i), in order of Add(), for every ball that reaches into the cone before
  // `along_end`, and for a few more: the test is in single precision and leans to the safe side.
  template <class Visit>
  void ForEachNear(const Cone& cone, double along_end, Visit&& visit) const {
    const Eigen::Vector3f o = cone.origin.cast<float>(), d = cone.direction.cast<float>();
    const auto base = static_cast<float>(cone.base_w), sine = static_cast<float>(cone.sine);
    const auto stretch =
        kSlack / static_cast<float>(std::sqrt(std::max(1e-6, 1 - cone.sine * cone.sine)));
    const auto end = static_cast<float>(along_end);
    for (uint32_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      const Lanes x = block.x - o.x(), y = block.y - o.y(), z = block.z - o.z();
      const Lanes along = x * d.x() + y * d.y() + z * d.z();
      const Lanes distance2 = x * x + y * y + z * z;
      const Lanes reach = (block.radius + base + along.max(0.0F) * sine) * stretch;
      const Lanes from_cone2 = distance2 * (1 - kRounding) - along * along - reach * reach;
      const Lanes outside = from_cone2.max((along - end).max(-along) - reach);
      Visited(outside, b, visit);
    }
  }

  // The same for every ball whose radius times `factor` reaches the point.
  template <class Visit>
  void ForEachAround(const Vec3& point_world, double factor, Visit&& visit) const {
    const Eigen::Vector3f p = point_world.cast<float>();
    const auto squared = static_cast<float>(factor * factor) * kSlack;
    for (uint32_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      const Lanes distance2 =
          (block.x - p.x()).square() + (block.y - p.y()).square() + (block.z - p.z()).square();
      const Lanes outside = distance2 - squared * block.radius.square();
      Visited(outside, b, visit);
    }
  }

 private:
  static constexpr uint32_t kLanes = 8;
  static constexpr float kSlack = 1.001F;
  static constexpr float kRounding = 4e-6F;  // of squared distances, relative
  using Lanes = Eigen::Array<float, kLanes, 1>;
  struct Block {
    Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero(), radius = Lanes::Zero();
  };

  template <class Visit>
  void Visited(const Lanes& outside, uint32_t block, Visit&& visit) const {
    if (outside.minCoeff() >= 0) return;
    const uint32_t count = std::min(kLanes, count_ - block * kLanes);
    for (uint32_t lane = 0; lane < count; ++lane)
      if (outside[lane] < 0) visit(block * kLanes + lane);
  }

  std::vector<Block> blocks_;
  uint32_t count_ = 0;
};

}  // namespace lf
