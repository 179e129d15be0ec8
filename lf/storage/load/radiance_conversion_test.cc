// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/radiance_conversion.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr int kWorldWidth = 12, kWorldHeight = 8;
const PixelRect kPart{1, 2, 9, 7};  // pixels of the LF image that are converted
const PixelRect kStored{0, 1, 12, 8};

struct World {
  RadianceEncoding encoding;
  LfCamera camera;
  Intrinsics k;
};

World MakeWorld() {
  World world;
  world.encoding.max_radiance = 2;
  world.encoding.pedestal = 1024;
  world.k.cx_px = 5;
  world.k.cy_px = 4.5;
  world.k.width_px = kWorldWidth;
  world.k.height_px = kWorldHeight;
  return world;
}

template <class T>
ImagePart Stored(int channels) {
  Image<T> image(kStored.width(), kStored.height(), channels);
  uint64_t index = 0;
  for (T& value : image.pixels())
    value = std::is_floating_point_v<T> ? static_cast<T>(1.5 * RandomUnit(1, 0, index++))
                                        : static_cast<T>(RandomBits(1, 0, index++));
  ImagePart part;
  part.rect = kStored;
  part.image = std::move(image);
  return part;
}

// Returns v by the formula of light_field/model/radiance.h, applied literally.
template <class T>
uint16_t ByFormula(const World& world, T stored, int channel, int x, int y) {
  const double falloff = world.k.vignetting.Falloff(RadiusSquared(world.k, x + 0.5, y + 0.5));
  const double gain = world.camera.gain[static_cast<size_t>(channel)] / falloff;
  if constexpr (std::is_floating_point_v<T>)
    return QuantizeRadiance(world.encoding, stored, gain);
  else
    return RadianceTable(world.encoding, sizeof(T) * 8, gain)[stored];
}

template <class T>
void ExpectFormula(const World& world, int channels) {
  const ImagePart part = Stored<T>(channels);
  const auto& stored = std::get<Image<T>>(part.image);
  LfPixels pixels;
  pixels.Reset(kPart, world.encoding.bayer);
  ConvertRadiance(part, channels, RadianceTables(world.encoding, ChannelGains()), world.encoding,
                  world.camera, world.k, &pixels);
  for (int y = kPart.y_begin; y < kPart.y_end; ++y)
    for (int x = kPart.x_begin; x < kPart.x_end; ++x) {
      const int column = x - kPart.x_begin, row = y - kPart.y_begin;
      if (world.encoding.bayer != BayerPattern::kNone) {
        const int channel = BayerChannel(world.encoding.bayer, x, y);
        ASSERT_EQ(pixels.radiance.at(column, row),
                  ByFormula(world, stored.at(x, y - kStored.y_begin), channel, x, y));
        continue;
      }
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(
            pixels.radiance.at(column, row, c),
            ByFormula(world, stored.at(x, y - kStored.y_begin, channels == 1 ? 0 : c), c, x, y));
      ASSERT_EQ(pixels.radiance.at(column, row, LfPixels::kRayLane), 1);
    }
}

void ExpectFormulaForAllFiles(World world) {
  for (const int channels : {1, 3}) {
    ExpectFormula<uint8_t>(world, channels);
    ExpectFormula<uint16_t>(world, channels);
    ExpectFormula<float>(world, channels);
  }
  world.encoding.transfer = Transfer::kLinear;
  for (const BayerPattern bayer : {BayerPattern::kRggb, BayerPattern::kGbrg}) {
    world.encoding.bayer = bayer;
    ExpectFormula<uint8_t>(world, 1);
    ExpectFormula<uint16_t>(world, 1);
    ExpectFormula<float>(world, 1);
  }
}

TEST(ConvertRadiance, PlainImagesAreAsTheirTableSays) { ExpectFormulaForAllFiles(MakeWorld()); }

TEST(ConvertRadiance, EachChannelHasItsGain) {
  World world = MakeWorld();
  world.camera.gain = {0.5f, 1, 1.7f};
  ExpectFormulaForAllFiles(world);
}

TEST(ConvertRadiance, RadianceIsDividedByTheFalloffAtThePixelsCentre) {
  World world = MakeWorld();
  world.k.vignetting.v = {-0.3, 0.05, -0.15};
  ExpectFormulaForAllFiles(world);
  world.camera.gain = {0.5f, 1, 1.7f};
  ExpectFormulaForAllFiles(world);
}

TEST(ConvertRadiance, LightIsClippedBelowTheRoomForOvershoot) {
  World world = MakeWorld();
  world.encoding.overshoot_room = 2;
  world.camera.gain = {0.5f, 3, 40};
  ExpectFormulaForAllFiles(world);
  world.k.vignetting.v = {-0.3, 0.05, -0.15};
  ExpectFormulaForAllFiles(world);
}

TEST(ConvertRadiance, AFalloffOfOneHalfDoublesTheLight) {
  World world = MakeWorld();
  world.encoding.transfer = Transfer::kLinear;
  world.encoding.pedestal = 0;
  world.k.cx_px = 0.5 - 12;  // the falloff's radius is 1 at the centre of the upper left pixel
  world.k.cy_px = 0.5;
  world.k.width_px = 24;
  world.k.height_px = 0;
  world.k.vignetting.v = {-0.5, 0, 0};
  Image<uint16_t> image(1, 1, 1);
  image.at(0, 0) = 10000;
  ImagePart part;
  part.rect = {0, 0, 1, 1};
  part.image = image;
  LfPixels pixels({0, 0, 1, 1}, BayerPattern::kNone);
  ConvertRadiance(part, 1, RadianceTables(world.encoding, ChannelGains()), world.encoding,
                  world.camera, world.k, &pixels);
  EXPECT_EQ(pixels.radiance.at(0, 0, 0), 10000);  // light is doubled, and max_radiance is 2
}

}  // namespace
}  // namespace lf
