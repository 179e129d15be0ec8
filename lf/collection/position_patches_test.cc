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

constexpr PixelRect kElements{0, 0, 1920, 1080};

// Adds the segments of [x_begin, x_end) of row y to `segments`. Their bounds must hold.
void Add(PositionPatches* patches, int y, int x_begin, int x_end, std::vector<Segment>* segments) {
  const size_t first = segments->size();
  std::vector<const PositionPatches::PositionBounds*> bounds;
  patches->Add(y, x_begin, x_end, segments, &bounds);
  ASSERT_EQ(bounds.size(), segments->size() - first);
  for (size_t i = 0; i < bounds.size(); ++i) {
    if (bounds[i] == nullptr) continue;
    const Segment& s = (*segments)[first + i];
    for (const int at : {0, s.count / 2, s.count - 1}) {
      const float t = s.t_begin + static_cast<float>(at);
      const Vec2 position =
          Vec2(s.base_x, s.base_y) + Vec2(PositionAt(s.x_poly, t), PositionAt(s.y_poly, t));
      ASSERT_TRUE((position.array() >= bounds[i]->low.array()).all()) << s.x_begin << " " << y;
      ASSERT_TRUE((position.array() <= bounds[i]->high.array()).all()) << s.x_begin << " " << y;
    }
  }
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
    PositionPatches patches(truth, kElements);
    for (int y = 0; y < 1080; y += 7) {
      std::vector<Segment> segments;
      Add(&patches, y, 3, 1917, &segments);
      const std::map<int, Vec2> positions = PositionsOf(segments);
      ASSERT_EQ(positions.size(), 1914u);
      for (const auto& [x, position] : positions)
        ASSERT_LT((position - *truth(x + 0.5, y + 0.5)).norm(), 1.5e-4) << x << " " << y;
    }
  }
}

TEST(PositionPatches, LeaveOutElementsWithoutAPosition) {
  const PositionPatches::Function truth = Bending(1.5, 600);
  PositionPatches patches(truth, kElements);
  for (int y = 0; y < 1080; y += 11) {
    std::vector<Segment> segments;
    Add(&patches, y, 0, 1920, &segments);
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

// An LF image that a patch surely fits into is not tested row by row.
TEST(PositionPatches, BoundsAreCloseIfTheLensBendsLittle) {
  const PositionPatches::Function truth = Bending(0.2);
  PositionPatches patches(truth, kElements);
  const Vec2 first = *truth(0.5, 0.5), last = *truth(1919.5, 1079.5);
  std::vector<Segment> segments;
  std::vector<const PositionPatches::PositionBounds*> bounds;
  for (int y = 0; y < 1080; ++y) {
    patches.Add(y, 0, 1920, &segments, &bounds);
    for (const PositionPatches::PositionBounds* bound : bounds) {
      ASSERT_NE(bound, nullptr) << y;
      ASSERT_TRUE((bound->low.array() > first.array() - 30).all()) << y;
      ASSERT_TRUE((bound->high.array() < last.array() + 30).all()) << y;
    }
  }
}

// The plan of a frame must not depend on the spans of a row that the lens leaves.
TEST(PositionPatches, DoNotDependOnTheElementsThatAreAskedFor) {
  const PositionPatches::Function truth = Bending(1.5, 900);
  PositionPatches whole(truth, kElements), parts(truth, {0, 100, 1920, 500});
  RandomSequence random(5);
  for (int y = 105; y < 500; y += 3) {
    std::vector<Segment> of_whole, of_parts;
    Add(&whole, y, 0, 1920, &of_whole);
    const int begin = static_cast<int>(random.Uniform(0, 1900));
    Add(&parts, y, begin, begin + 20, &of_parts);
    const std::map<int, Vec2> positions = PositionsOf(of_whole);
    for (const auto& [x, position] : PositionsOf(of_parts)) ASSERT_EQ(position, positions.at(x));
  }
}

}  // namespace
}  // namespace lf
