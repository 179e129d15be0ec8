// SPDX-License-Identifier: Apache-2.0
#include "lf/film/plate/sensor_plate.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

TEST(SensorPlate, HoldsTheMostRaysOfTheBrightestLight) {
  SensorPlate plate(2, 1);
  plate.Add(1, 0, 2, {uint64_t{65535} * SensorPlate::kMaxCount, SensorPlate::kMaxCount});
  EXPECT_EQ(plate.At(1, 0, 2),
            (ElementSum{uint64_t{65535} * SensorPlate::kMaxCount, SensorPlate::kMaxCount}));
  plate.AddRay(1, 0, 2, 65535);
  EXPECT_EQ(plate.At(1, 0, 2), (ElementSum{uint64_t{65535} << 24, uint64_t{1} << 24}));
  EXPECT_EQ(plate.At(1, 0, 1), ElementSum{});
  EXPECT_EQ(plate.At(0, 0, 2), ElementSum{});
}

// The thesis (5.2) needs width x height x 6 x 4 B, for three sums and three counts. A plate needs
// the same, and no more when rays are added.
TEST(SensorPlate, TakesTheBytesOfTheThesis) {
  SensorPlate plate(1920, 1080);
  EXPECT_EQ(plate.size_bytes(), size_t{1920} * 1080 * 6 * 4);
  for (int ray = 0; ray < 1000; ++ray) plate.AddRay(7, 9, 1, 65535);
  EXPECT_EQ(plate.size_bytes(), size_t{1920} * 1080 * 6 * 4);
}

TEST(SensorPlate, LosesNothingWhenWordsArePromoted) {
  SensorPlate plate(4, 4, 10);  // a packed word holds at most ten rays
  ElementSum expected[4][4][3] = {};
  for (uint64_t i = 0; i < 5000; ++i) {
    const int x = RandomBits(1, 0, i) % 4, y = RandomBits(1, 1, i) % 4, c = RandomBits(1, 2, i) % 3;
    const auto v = static_cast<uint16_t>(RandomBits(1, 3, i));
    plate.AddRay(x, y, c, v);
    expected[y][x][c].sum += v;
    expected[y][x][c].count += 1;
  }
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(plate.At(x, y, c), expected[y][x][c]);
}

TEST(PlateTile, ReservesRoomByPromoting) {
  SensorPlate small(3, 4, 7);
  SensorPlate large(3, 4);
  PlateTile tile(&small, {1, 1, 3, 3});
  for (uint64_t i = 0; i < 1000; ++i) {
    tile.Reserve(2);
    for (int k = 0; k < 2; ++k) {
      const uint64_t bits = RandomBits(5, static_cast<uint64_t>(k), i);
      const int x = 1 + bits % 2, y = 1 + (bits >> 8) % 2, c = (bits >> 16) % 3;
      const auto v = static_cast<uint16_t>(bits >> 32);
      tile.row(y)[(x - 1) * 3 + c] += SensorPlate::kOneRay | v;
      large.AddRay(x, y, c, v);
    }
  }
  EXPECT_EQ(small, large);
}

TEST(SensorPlate, MergingInAnyOrderGivesTheSamePlate) {
  std::vector<SensorPlate> parts;
  for (uint64_t p = 0; p < 3; ++p) {
    parts.emplace_back(5, 3, p == 1 ? 4 : SensorPlate::kMaxCount);
    for (uint64_t i = 0; i < 400; ++i) {
      const uint64_t bits = RandomBits(9, p, i);
      parts[p].AddRay(bits % 5, (bits >> 8) % 3, (bits >> 16) % 3, (bits >> 24) & 0xffff);
    }
  }
  SensorPlate forward(5, 3), backward(5, 3, 20);
  for (int p = 0; p < 3; ++p) forward.Merge(parts[p]);
  for (int p = 2; p >= 0; --p) backward.Merge(parts[p]);
  EXPECT_EQ(forward, backward);
  forward.AddRay(0, 0, 0, 1);
  EXPECT_FALSE(forward == backward);
}

}  // namespace
}  // namespace lf
