// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/spread_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "lf/core/random.h"
#include "lf/light_field/model/brackets.h"
#include "lf/selection/image_order.h"
#include "lf/selection/spread_sequence.h"

namespace lf {
namespace {

std::vector<SurfacePoint> GridPoints(int columns, int rows, int32_t pitch = 1000) {
  std::vector<SurfacePoint> points;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) points.push_back({pitch * x, pitch * y});
  return points;
}

std::vector<SurfacePoint> RandomPoints(uint32_t count) {
  std::vector<SurfacePoint> points;
  for (uint32_t i = 0; i < count; ++i)
    points.push_back({static_cast<int32_t>(RandomBits(4, 0, i) % SurfacePoint::kMost),
                      static_cast<int32_t>(RandomBits(4, 1, i) % SurfacePoint::kMost)});
  return points;
}

LightField FieldOf(const std::vector<SurfacePoint>& points) {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100});
  for (const SurfacePoint& point : points) {
    LfCamera camera;
    camera.cam_from_world.translation = -1e-6 * Vec3(point.x, point.y, 0);
    field.cameras.push_back(camera);
    field.image_names.push_back(std::to_string(field.size()) + ".png");
  }
  return field;
}

// Returns how far the share of the points that a lens has among the first `count` of an order is
// from its share among all: the root of the mean square over many lenses.
double Discrepancy(const std::vector<SurfacePoint>& points, const std::vector<uint32_t>& order,
                   size_t count) {
  double square = 0;
  constexpr uint32_t kLenses = 400;
  for (uint32_t lens = 0; lens < kLenses; ++lens) {
    const double x = RandomUnit(9, 0, lens) * SurfacePoint::kMost;
    const double y = RandomUnit(9, 1, lens) * SurfacePoint::kMost;
    const double radius = (0.1 + 0.3 * RandomUnit(9, 2, lens)) * SurfacePoint::kMost;
    const auto is_inside = [&](uint32_t i) {
      return std::hypot(points[i].x - x, points[i].y - y) < radius;
    };
    size_t first = 0, all = 0;
    for (size_t rank = 0; rank < order.size(); ++rank)
      if (is_inside(order[rank])) {
        ++all;
        first += rank < count ? 1 : 0;
      }
    const double difference = static_cast<double>(first) / static_cast<double>(count) -
                              static_cast<double>(all) / static_cast<double>(order.size());
    square += difference * difference / kLenses;
  }
  return std::sqrt(square);
}

std::vector<uint32_t> Shuffled(size_t count, uint64_t seed) {
  const ImageRanks ranks = ShuffledRanks(count, seed);
  std::vector<uint32_t> order(count);
  for (uint32_t id = 0; id < count; ++id) order[ranks.of_images[id]] = id;
  return order;
}

TEST(SpreadOrder, HasEachPointOnce) {
  for (const std::vector<SurfacePoint>& points :
       {RandomPoints(1000), GridPoints(27, 19), GridPoints(1, 50), GridPoints(3, 3),
        std::vector<SurfacePoint>(40, SurfacePoint{7, 7}), std::vector<SurfacePoint>(1)}) {
    std::vector<uint32_t> order = OrderOfPoints(points, 3);
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(order, all);
  }
  EXPECT_TRUE(OrderOfPoints({}, 3).empty());
}

// In a grid of 2^k columns and rows, the point of rank r is the one in whose cell the r-th point of
// the sequence lies. Each block of 4^j ranks therefore has one point in each of 4^j squares.
TEST(SpreadOrder, OfASquareGridIsTheSequence) {
  const std::vector<uint32_t> order = OrderOfPoints(GridPoints(32, 32), 11);
  const std::vector<SpreadPoint> sequence = SpreadSequence(1024, 11);
  for (size_t rank = 0; rank < order.size(); ++rank) {
    EXPECT_EQ(order[rank] % 32, sequence[rank].x >> 27);
    EXPECT_EQ(order[rank] / 32, sequence[rank].y >> 27);
  }
  for (const uint32_t side : {2, 4, 8, 16})
    for (uint32_t block = 0; block < 1024 / (side * side); ++block) {
      std::set<uint32_t> squares;
      for (uint32_t i = 0; i < side * side; ++i) {
        const uint32_t id = order[block * side * side + i];
        squares.insert(id % 32 * side / 32 + 32 * (id / 32 * side / 32));
      }
      EXPECT_EQ(squares.size(), side * side);
    }
}

// The definition in spread_order.h, one rank after the other: a point of the sequence descends the
// cuts to a rectangle, and avoids parts that have no free point.
class Descent {
 public:
  explicit Descent(std::vector<SurfacePoint> points) : points_(std::move(points)) {
    std::vector<uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0U);
    root_ = Make(all);
  }
  uint32_t Next(const SpreadPoint& target) {
    size_t part = root_;
    std::array<double, 2> low = {0, 0}, high = {1, 1};
    const std::array<double, 2> at = {target.x * 0x1p-32, target.y * 0x1p-32};
    --parts_[part].free;
    while (parts_[part].ids.size() > 1) {
      const Part& here = parts_[part];
      const size_t k = here.axis;
      const double share =
          static_cast<double>(parts_[here.first].ids.size()) / static_cast<double>(here.ids.size());
      const double cut = low[k] + (high[k] - low[k]) * share;
      bool goes_first = at[k] < cut;
      if (parts_[goes_first ? here.first : here.second].free == 0) goes_first = !goes_first;
      (goes_first ? high : low)[k] = cut;
      part = goes_first ? here.first : here.second;
      --parts_[part].free;
    }
    return parts_[part].ids[0];
  }

 private:
  struct Part {
    std::vector<uint32_t> ids;
    size_t free = 0, axis = 0, first = 0, second = 0;
  };
  int64_t At(uint32_t id, size_t axis) const { return axis == 0 ? points_[id].x : points_[id].y; }

  size_t Make(std::vector<uint32_t> ids) {
    const size_t count = ids.size();
    Part part{ids, count};
    if (count > 1) {
      std::array<int64_t, 2> extent;
      for (const size_t k : {0, 1}) {
        std::sort(ids.begin(), ids.end(),
                  [&](uint32_t a, uint32_t b) { return At(a, k) < At(b, k); });
        extent[k] = At(ids.back(), k) - At(ids.front(), k);
      }
      const size_t longer = extent[1] > extent[0] ? 1 : 0;
      size_t cut = 0;
      for (const size_t k : {longer, 1 - longer}) {
        if (cut > 0) break;
        part.axis = k;
        std::sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) {
          return std::tuple(At(a, k), At(a, 1 - k), a) < std::tuple(At(b, k), At(b, 1 - k), b);
        });
        int64_t widest = 0;
        for (size_t i = 1; i < count; ++i)
          if (3 * i >= count && 3 * (count - i) >= count)
            widest = std::max(widest, At(ids[i], k) - At(ids[i - 1], k));
        // From the middle outwards, the smaller part first.
        for (size_t off = 0; off < count && widest > 0 && cut == 0; ++off)
          for (const size_t twice : {count - off, count + off})
            if (const size_t i = twice / 2; twice % 2 == 0 && cut == 0 && i > 0 && i < count &&
                                            3 * i >= count && 3 * (count - i) >= count &&
                                            2 * (At(ids[i], k) - At(ids[i - 1], k)) >= widest)
              cut = i;
      }
      if (cut == 0) {
        part.axis = longer;
        cut = count / 2;
        std::sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) {
          return std::tuple(At(a, longer), At(a, 1 - longer), a) <
                 std::tuple(At(b, longer), At(b, 1 - longer), b);
        });
      }
      const auto middle = ids.begin() + static_cast<ptrdiff_t>(cut);
      part.first = Make({ids.begin(), middle});
      part.second = Make({middle, ids.end()});
    }
    parts_.push_back(part);
    return parts_.size() - 1;
  }

  std::vector<SurfacePoint> points_;
  std::vector<Part> parts_;
  size_t root_ = 0;
};

TEST(SpreadOrder, IsTheDescentThatItIsDefinedBy) {
  std::vector<SurfacePoint> bursts = RandomPoints(30);
  for (uint32_t i = 0; i < 200; ++i) bursts.push_back(bursts[i % 7]);
  for (const std::vector<SurfacePoint>& points :
       {RandomPoints(600), GridPoints(27, 27), GridPoints(48, 6), GridPoints(3, 3), bursts}) {
    Descent descent(points);
    const std::vector<SpreadPoint> sequence = SpreadSequence(points.size(), 4);
    const std::vector<uint32_t> order = OrderOfPoints(points, 4);
    for (size_t rank = 0; rank < order.size(); ++rank)
      ASSERT_EQ(order[rank], descent.Next(sequence[rank])) << rank << " of " << order.size();
  }
}

TEST(SpreadOrder, BeginningsAndPartsAreSpreadInEveryLens) {
  for (const std::vector<SurfacePoint>& points :
       {GridPoints(27, 27, SurfacePoint::kMost / 26), RandomPoints(700)}) {
    const std::vector<uint32_t> order = OrderOfPoints(points, 1);
    for (const size_t count : {32, 100, 300}) {
      double shuffled = 0;
      for (const uint64_t seed : {1, 2, 3, 4})
        shuffled += Discrepancy(points, Shuffled(points.size(), seed), count) / 4;
      EXPECT_LT(Discrepancy(points, order, count), (count > 32 ? 0.5 : 0.7) * shuffled) << count;
      for (const size_t step : {2, 4}) {  // shards
        std::vector<uint32_t> shard, others;
        for (size_t rank = 0; rank < order.size(); ++rank)
          (rank % step == 1 ? shard : others).push_back(order[rank]);
        const size_t shard_count = shard.size();
        shard.insert(shard.end(), others.begin(), others.end());
        double of_shuffled = 0;
        for (const uint64_t seed : {1, 2, 3, 4})
          of_shuffled += Discrepancy(points, Shuffled(points.size(), seed), shard_count) / 4;
        EXPECT_LT(Discrepancy(points, shard, shard_count), 0.8 * of_shuffled) << step;
      }
    }
  }
}

TEST(SpreadOrder, DependsOnPositionsAndSeedAlone) {
  LightField field = FieldOf(GridPoints(12, 9));
  const std::vector<uint32_t> order = SpreadOrder(field, 5);
  EXPECT_EQ(SpreadOrder(field, 5), order);
  EXPECT_NE(SpreadOrder(field, 6), order);
  for (LfCamera& camera : field.cameras) camera.gain = 2;
  EXPECT_EQ(SpreadOrder(field, 5), order);
  EXPECT_EQ(RanksOf(ImageOrder::kSpread, field, 5).of_images[order[17]], 17U);
}

// The LF images of a pose follow each other, and poses are spread as if each had one LF image.
TEST(SpreadOrder, BracketsStayTogether) {
  const std::vector<SurfacePoint> points = GridPoints(8, 8);
  const std::vector<uint32_t> poses = SpreadOrder(FieldOf(points), 5);
  std::vector<SurfacePoint> three_times;
  for (const SurfacePoint& point : points) three_times.insert(three_times.end(), 3, point);
  LightField field = FieldOf(three_times);
  field.encoding.masks_clipped = true;
  for (uint32_t i = 0; i < field.size(); ++i) field.cameras[i].gain = i % 3 == 0 ? 1.0F : i % 3 * 4;
  EXPECT_EQ(ApplyBrackets(&field), 128U);
  const std::vector<uint32_t> order = SpreadOrder(field, 5);
  for (uint32_t rank = 0; rank < order.size(); ++rank)
    EXPECT_EQ(order[rank], 3 * poses[rank / 3] + rank % 3);
  // A packed store has the poses, but does not know which LF images are brackets.
  for (LfCamera& camera : field.cameras) {
    camera.brighter = LfCamera::kNone;
    camera.masks_clipped = false;
  }
  EXPECT_EQ(SpreadOrder(field, 5), order);
}

TEST(SpreadOrder, VirtualLfImagesComeBetweenRecordedOnes) {
  const std::vector<uint32_t> alone = SpreadOrder(FieldOf(GridPoints(6, 6)), 5);
  std::vector<SurfacePoint> all = GridPoints(6, 6);
  for (SurfacePoint point : GridPoints(5, 5))
    for (const int32_t at : {300, 600}) all.push_back({point.x + at, point.y + at});
  LightField field = FieldOf(all);
  for (size_t i = 36; i < field.size(); ++i) field.cameras[i].is_virtual = true;
  const std::vector<uint32_t> order = SpreadOrder(field, 5);
  std::vector<uint32_t> recorded;
  for (size_t rank = 0; rank < order.size(); ++rank) {
    if (order[rank] < 36) recorded.push_back(order[rank]);
    EXPECT_NEAR(static_cast<double>(recorded.size()), 36.0 / 86 * (rank + 1), 1);
  }
  EXPECT_EQ(recorded, alone);
}

}  // namespace
}  // namespace lf
