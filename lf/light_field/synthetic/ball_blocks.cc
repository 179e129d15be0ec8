// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/ball_blocks.h"

#include <numeric>

namespace lf {

BallBlocks::BallBlocks(const std::vector<Ball>& balls) {
  Indices order(balls.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!balls.empty()) Build(balls, order, 0, balls.size());
}

// Makes order[begin, end) a block if it has at most kLanes balls. Otherwise splits it in two,
// across the longest side of the bounding box of the balls' centres, and continues with both parts.
// The size of the first part is a multiple of kLanes.
void BallBlocks::Build(const std::vector<Ball>& balls, Indices& order, size_t begin, size_t end) {
  Eigen::AlignedBox3d box;
  for (size_t i = begin; i < end; ++i) box.extend(balls[order[i]].centre_world);
  if (end - begin > kLanes) {
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto at = [&](uint32_t i) { return balls[i].centre_world[axis]; };
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end),
              [&](uint32_t a, uint32_t b) { return at(a) != at(b) ? at(a) < at(b) : a < b; });
    const size_t block_count = (end - begin + kLanes - 1) / kLanes;
    const size_t middle = begin + block_count / 2 * kLanes;
    Build(balls, order, begin, middle);
    Build(balls, order, middle, end);
    return;
  }
  Block block;
  block.around.centre_world = box.center();
  for (size_t i = begin; i < end; ++i, ++block.count) {
    const Ball& ball = balls[order[i]];
    const double far_side_w = (ball.centre_world - box.center()).norm() + ball.radius_w;
    block.around.radius_w = std::max(block.around.radius_w, far_side_w);
    block.largest_radius_w = std::max(block.largest_radius_w, ball.radius_w);
    block.x[block.count] = static_cast<float>(ball.centre_world.x());
    block.y[block.count] = static_cast<float>(ball.centre_world.y());
    block.z[block.count] = static_cast<float>(ball.centre_world.z());
    block.radius[block.count] = static_cast<float>(ball.radius_w);
    block.index[static_cast<size_t>(block.count)] = order[i];
  }
  blocks_.push_back(block);
}

}  // namespace lf
