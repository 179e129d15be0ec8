// SPDX-License-Identifier: Apache-2.0
#include "lf/film/plate/tile_sums.h"

#include <gtest/gtest.h>

#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

// Returns the indices of the words that hold the mosaic sums of a channel of the element (x, y) of
// a tile: one word for red or blue, two for green.
std::vector<size_t> WordsOf(const TileSums& sums, int x, int y, int channel) {
  const int odd = x % 2;
  const auto word = [&](int kind) {
    return (static_cast<size_t>(y) * TileSums::kMosaicRows + static_cast<size_t>(kind)) *
               static_cast<size_t>(sums.stride()) +
           static_cast<size_t>(x);
  };
  const int other_first = odd ? TileSums::kGreenFirst : TileSums::kRedFirst;
  const int green_first = odd ? TileSums::kRedFirst : TileSums::kGreenFirst;
  if (channel == 0) return {word(other_first)};
  if (channel == 2) return {word(TileSums::kBlueFirst + other_first)};
  return {word(green_first), word(TileSums::kBlueFirst + green_first)};
}

TEST(TileSums, MosaicsAndRgbReachThePlate) {
  for (const int width : {1, 2, 7, 20}) {
    SensorPlate plate(23, 9), expected(23, 9);
    PlateTile tile(&plate, {2, 3, 2 + width, 8});
    TileSums sums(50);  // so few rays that sums are flushed now and then
    sums.Begin(&tile);
    for (uint64_t ray = 0; ray < 500; ++ray) {
      const auto random = [&](uint64_t index, int end) {
        return static_cast<int>(RandomUnit(ray, index, 0) * end);
      };
      const int x = random(0, width), y = random(1, 5), channel = random(2, 3);
      const auto v = static_cast<uint16_t>(random(3, 65536));
      if (ray % 3 == 0) {
        TileSums::Element& element = sums.ReserveRgb(1)[y * sums.stride() + x];
        element.rgb_rays[channel] += v;
        ++element.rgb_rays[3];
        for (int c = 0; c < 3; ++c)
          expected.AddRay(2 + x, 3 + y, c, c == channel ? v : uint16_t{0});
        continue;
      }
      const std::vector<size_t> words = WordsOf(sums, x, y, channel);
      sums.ReserveMosaic(1)[words[ray % words.size()]] += SensorPlate::kOneRay | v;
      expected.AddRay(2 + x, 3 + y, channel, v);
    }
    sums.Flush();
    EXPECT_EQ(plate, expected) << width;
    // Nothing is left for the next tile.
    sums.Begin(&tile);
    sums.ReserveRgb(1);
    sums.ReserveMosaic(1);
    sums.Flush();
    EXPECT_EQ(plate, expected) << width;
  }
}

TEST(TileSums, ColoursReachTheChannelsThatTheTargetNames) {
  SensorPlate plate(5, 4, PlateKind::kGuarded), expected(5, 4, PlateKind::kGuarded);
  PlateTile tile(&plate, {1, 1, 5, 4});
  TileSums sums(50);
  sums.Begin(&tile, {}, {.channel = plate.all_rays_channel()});
  sums.ReserveRgb(1)[sums.stride() + 2] = {{10, 20, 30, 1}};
  sums.Flush();
  for (int c = 0; c < 3; ++c) expected.Add(3, 2, 4 + c, {10 + 10 * static_cast<uint64_t>(c), 1});
  EXPECT_EQ(plate, expected);
}

TEST(TileSums, SomeColoursReachTheChannelsThatTheTargetNames) {
  SensorPlate plate(5, 4, PlateKind::kGuardedOpacity);
  SensorPlate expected(5, 4, PlateKind::kGuardedOpacity);
  PlateTile tile(&plate, {1, 1, 5, 4});
  TileSums sums(50);
  sums.Begin(&tile, {}, {.channel = 8, .first = 1, .count = 2});
  sums.ReserveRgb(2)[sums.stride() + 2] = {{10, 20, 30, 2}};
  sums.Flush();
  expected.Add(3, 2, 8, {20, 2});
  expected.Add(3, 2, 9, {30, 2});
  EXPECT_EQ(plate, expected);
}

TEST(TileSums, OpacityReachesTheFourthChannelAlone) {
  SensorPlate plate(23, 9, PlateKind::kOpacity), expected(23, 9, PlateKind::kOpacity);
  PlateTile tile(&plate, {2, 3, 22, 8});
  TileSums sums(50);  // so few rays that sums are flushed now and then
  for (const bool is_opacity : {false, true}) {
    sums.Begin(&tile, {},
               is_opacity ? TileSums::Target{.channel = 3, .count = 1} : TileSums::Target());
    for (uint64_t ray = 0; ray < 300; ++ray) {
      const int x = static_cast<int>(RandomUnit(ray, 0, 0) * 20);
      const int y = static_cast<int>(RandomUnit(ray, 1, 0) * 5);
      TileSums::Element& element = sums.ReserveRgb(1)[y * sums.stride() + x];
      for (int c = 0; c < 3; ++c) {
        const auto v = static_cast<uint16_t>(is_opacity ? ray * 200 : RandomBits(ray, 2, c));
        element.rgb_rays[c] += v;
        if (!is_opacity) expected.AddRay(2 + x, 3 + y, c, v);
        if (is_opacity && c == 0) expected.AddRay(2 + x, 3 + y, SensorPlate::kOpacityChannel, v);
      }
      ++element.rgb_rays[3];
    }
    sums.Flush();
  }
  EXPECT_EQ(plate, expected);
}

// Uses both layouts in one tile of a plate to which rays were added before, and some of whose
// words move to the wide table meanwhile.
TEST(TileSums, TellsWhatWasAddedToWatchedElements) {
  SensorPlate plate(23, 9, 60), added(23, 9);
  plate.Add(5, 4, 1, {300, 55});
  PlateTile tile(&plate, {2, 3, 21, 8});
  const std::vector<PlateElement> watched = {{2, 3}, {5, 4}, {6, 4}, {20, 7}, {19, 7}};
  TileSums sums(50);  // so few rays that sums are flushed now and then
  const auto expect_added = [&](uint64_t ray) {
    for (size_t i = 0; i < watched.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(sums.Added(i, c), added.At(watched[i].x, watched[i].y, c)) << ray << " " << i;
  };
  sums.Begin(&tile, watched);
  for (uint64_t ray = 0; ray < 900; ++ray) {
    const auto random = [&](uint64_t index, int end) {
      return static_cast<int>(RandomUnit(ray, index, 0) * end);
    };
    const PlateElement& element = watched[static_cast<size_t>(random(0, 5))];
    const int x = element.x - 2, y = element.y - 3, channel = random(2, 3);
    const auto v = static_cast<uint16_t>(random(3, 65536));
    if (ray % 2 == 0) {
      TileSums::Element& rgb = sums.ReserveRgb(1)[y * sums.stride() + x];
      rgb.rgb_rays[channel] += v;
      ++rgb.rgb_rays[3];
      for (int c = 0; c < 3; ++c)
        added.AddRay(element.x, element.y, c, c == channel ? v : uint16_t{0});
    } else {
      const std::vector<size_t> words = WordsOf(sums, x, y, channel);
      sums.ReserveMosaic(1)[words[ray % words.size()]] += SensorPlate::kOneRay | v;
      added.AddRay(element.x, element.y, channel, v);
    }
    if (ray % 7 == 0) expect_added(ray);
  }
  sums.Flush();
  expect_added(900);
  EXPECT_FALSE(plate.wide().empty());
  SensorPlate total(23, 9);
  total.Add(5, 4, 1, {300, 55});
  total.Merge(added);
  EXPECT_EQ(plate, total);
  sums.Begin(&tile, watched);
  EXPECT_EQ(sums.Added(0, 0), ElementSum{});
  sums.Flush();
}

}  // namespace
}  // namespace lf
