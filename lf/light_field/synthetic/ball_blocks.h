// SPDX-License-Identifier: Apache-2.0
// Finds the few balls near a ray quickly. Up to eight balls near each other form a block: a ball
// around the block is tested first, then the balls of the block are tested side by side. For about
// a hundred balls, as in the built-in scenes, blocks are faster than a tree.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"

namespace lf {

struct Ball {
  Vec3 centre_world = Vec3::Zero();
  double radius_w = 0;
};

// A cone around the half-line from `origin` along `direction` (unit length). It contains the points
// at a distance `along` from 0 to along_end along the half-line whose distance from the half-line
// is less than base_w / cos(a) + along tan(a), where a is half the opening angle and `sine` its
// sine. Lengths are world units.
struct Cone {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();
  double along_end = 0;
  double base_w = 0;
  double sine = 0;
};

class BallBlocks {
 public:
  BallBlocks() = default;
  explicit BallBlocks(const std::vector<Ball>& balls);

  // Calls visit(i) for the index i of every ball that reaches into the cone, and perhaps for some
  // other balls: the test in single precision is so wide that it never misses a ball. Equal
  // arguments give an equal order of calls.
  template <class Visit>
  void ForEachNear(const Cone& cone, Visit&& visit) const;

  // Calls visit(i) for every ball that would contain the point if its radius were multiplied by
  // `factor`, and perhaps for some others.
  template <class Visit>
  void ForEachAround(const Vec3& point_world, double factor, Visit&& visit) const;

 private:
  static constexpr int kLanes = 8;           // number of balls in a block
  static constexpr float kSlack = 1.001F;    // factor by which the tests are too wide
  static constexpr float kRounding = 4e-6F;  // largest relative error of squared distances
  using Lanes = Eigen::Array<float, kLanes, 1>;
  struct Block {
    Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero(), radius = Lanes::Zero();
    Ball around;
    double largest_radius_w = 0;
    std::array<uint32_t, kLanes> index = {};
    int count = 0;
  };
  using Indices = std::vector<uint32_t>;
  void Build(const std::vector<Ball>& balls, Indices& order, size_t begin, size_t end);

  template <class Visit>
  static void VisitInside(const Block& block, const Lanes& outside, Visit&& visit) {
    if (outside.minCoeff() >= 0) return;
    for (int lane = 0; lane < block.count; ++lane)
      if (outside[lane] < 0) visit(block.index[static_cast<size_t>(lane)]);
  }

  std::vector<Block> blocks_;
};

template <class Visit>
void BallBlocks::ForEachNear(const Cone& cone, Visit&& visit) const {
  const Eigen::Vector3f o = cone.origin.cast<float>(), d = cone.direction.cast<float>();
  const double inverse_cosine =
      cone.sine == 0 ? 1 : 1 / std::sqrt(std::max(1e-6, 1 - cone.sine * cone.sine));
  const auto base = static_cast<float>(cone.base_w), sine = static_cast<float>(cone.sine);
  const auto stretch = kSlack * static_cast<float>(inverse_cosine);
  const auto end = static_cast<float>(cone.along_end);
  for (const Block& block : blocks_) {
    const Vec3 to_block = block.around.centre_world - cone.origin;
    const double block_along = to_block.dot(cone.direction);
    const double block_reach =
        (block.around.radius_w + cone.base_w + std::max(0.0, block_along) * cone.sine) *
        inverse_cosine;
    if (to_block.squaredNorm() - block_along * block_along > block_reach * block_reach ||
        block_along < -block_reach || block_along - cone.along_end > block_reach)
      continue;
    const Lanes x = block.x - o.x(), y = block.y - o.y(), z = block.z - o.z();
    const Lanes along = x * d.x() + y * d.y() + z * d.z();
    const Lanes distance2 = x * x + y * y + z * z;
    const Lanes reach = (block.radius + base + along.max(0.0F) * sine) * stretch;
    const Lanes from_cone2 = distance2 * (1 - kRounding) - along * along - reach * reach;
    VisitInside(block, from_cone2.max((along - end).max(-along) - reach), visit);
  }
}

template <class Visit>
void BallBlocks::ForEachAround(const Vec3& point_world, double factor, Visit&& visit) const {
  const Eigen::Vector3f p = point_world.cast<float>();
  const auto squared = static_cast<float>(factor * factor) * kSlack;
  for (const Block& block : blocks_) {
    const double block_reach = block.around.radius_w + factor * block.largest_radius_w;
    if ((block.around.centre_world - point_world).squaredNorm() > block_reach * block_reach)
      continue;
    const Lanes distance2 =
        (block.x - p.x()).square() + (block.y - p.y()).square() + (block.z - p.z()).square();
    VisitInside(block, distance2 - squared * block.radius.square(), visit);
  }
}

}  // namespace lf
