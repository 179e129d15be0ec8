// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/position_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

// A lens that bends more the farther a ray is from (960, 540): strongly (fish-eye) if `bend` is
// large. There are no positions at distances above `edge` from there.
PositionPatches::Function Bending(double bend, double edge = 1e9) {
  return [=](double x, double y) -> std::optional<Vec2> {
    const Vec2 place = Vec2(x - 960, y - 540) / 1000;
    const double r = place.norm();
    if (1000 * r > edge) return std::nullopt;
    const double scale = r == 0 ? 1 : std::atan(bend * r) / (bend * r);
    return Vec2(700, 500) + 1100 * scale * place;
  };
}

// Returns the positions of elements, by their x, as kernels compute them.
std::map<int, Vec2> PositionsOf(const std::vector<Segment>& segments) {
  std::map<int, Vec2> positions;
  for (const Segment& s : segments)
    for (int i = 0; i < s.count; ++i) {
      const float t = s.t_begin + static_cast<float>(i);
      positions[s.x_begin + i] =
          Vec2(s.base_x, s.base_y) + Vec2(PositionAt(s.x_poly, t), PositionAt(s.y_poly, t));
    }
  return positions;
}

TEST(PositionPatches, ArePositionsOfTheFunction) {
  for (const double bend : {0.05, 0.5, 1.5, 4.0}) {
    const PositionPatches::Function truth = Bending(bend);
    PositionPatches patches(truth);
    for (int y = 0; y < 1080; y += 7) {
      std::vector<Segment> segments;
      patches.Add(y, 3, 1917, &segments);
      const std::map<int, Vec2> positions = PositionsOf(segments);
      ASSERT_EQ(positions.size(), 1914u);
      for (const auto& [x, position] : positions)
        ASSERT_LT((position - *truth(x + 0.5, y + 0.5)).norm(), 1.5e-4) << x << " " << y;
    }
  }
}

TEST(PositionPatches, LeaveOutElementsWithoutAPosition) {
  const PositionPatches::Function truth = Bending(1.5, 600);
  PositionPatches patches(truth);
  for (int y = 0; y < 1080; y += 11) {
    std::vector<Segment> segments;
    patches.Add(y, 0, 1920, &segments);
    const std::map<int, Vec2> positions = PositionsOf(segments);
    for (int x = 0; x < 1920; ++x) {
      const std::optional<Vec2> expected = truth(x + 0.5, y + 0.5);
      // At the edge itself, a piece of one element decides by the element's centre.
      ASSERT_EQ(positions.contains(x), expected.has_value()) << x << " " << y;
      if (expected) {
        ASSERT_LT((positions.at(x) - *expected).norm(), 1.5e-4) << x << " " << y;
      }
    }
  }
}

// The plan of a frame must not depend on the spans of a row that the lens leaves.
TEST(PositionPatches, DoNotDependOnTheElementsThatAreAskedFor) {
  const PositionPatches::Function truth = Bending(1.5, 900);
  PositionPatches whole(truth), parts(truth);
  RandomSequence random(5);
  for (int y = 5; y < 400; y += 3) {
    std::vector<Segment> of_whole, of_parts;
    whole.Add(y, 0, 1920, &of_whole);
    const int begin = static_cast<int>(random.Uniform(0, 1900));
    parts.Add(y, begin, begin + 20, &of_parts);
    const std::map<int, Vec2> positions = PositionsOf(of_whole);
    for (const auto& [x, position] : PositionsOf(of_parts)) ASSERT_EQ(position, positions.at(x));
  }
}

}  // namespace
}  // namespace lf
