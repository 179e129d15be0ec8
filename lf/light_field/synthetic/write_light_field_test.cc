// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/write_light_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "lf/core/file.h"
#include "lf/light_field/synthetic/built_in_scenes.h"
#include "lf/light_field/synthetic/photograph.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class WriteLightFieldTest : public FolderTest {
 protected:
  // Returns a light field of four cameras that are far apart and have jitter.
  LightField SmallField(const BuiltInScene& scene, LfImageFormat format, int width, int height) {
    RigOptions rig = scene.rig;
    rig.count = 4;
    rig.spacing_w = 0.03;
    rig.jitter = 0.3;
    return DescribeLightField(*MakeRig(rig), IntrinsicsFor(scene, width, height), format,
                              scene.max_radiance, folder_);
  }
  ThreadPool pool_{2};
};

// Returns the centre of the light within a few pixels of a position.
Vec2 CentreOfLight(const Image<float>& picture, const Vec2& place) {
  constexpr int kReach = 5;
  double sum = 0;
  Vec2 moment = Vec2::Zero();
  for (int y = static_cast<int>(place.y()) - kReach; y <= place.y() + kReach; ++y)
    for (int x = static_cast<int>(place.x()) - kReach; x <= place.x() + kReach; ++x) {
      const double light = static_cast<double>(picture.at(x, y, 1));
      sum += light;
      moment += light * Vec2(x + 0.5, y + 0.5);
    }
  return moment / sum;
}

TEST_F(WriteLightFieldTest, EveryLampIsWhereTheWrittenCalibrationProjectsIt) {
  const BuiltInScene& lights = *FindBuiltInScene("lights");
  const SceneDescription description = lights.describe();
  ASSERT_TRUE(WriteLightField(Scene(description), SmallField(lights, LfImageFormat::kExr, 240, 160),
                              {}, pool_));
  const LightField read = *ReadTransformsJson(folder_ / "transforms.json");
  ASSERT_EQ(read.size(), 4U);
  int seen = 0;
  for (uint32_t i = 0; i < read.size(); ++i) {
    const StoredImage stored = *ReadImage(read.ImagePath({i}));
    const auto& picture = std::get<Image<float>>(stored);
    for (const Glow& glow : description.glows) {
      const std::optional<Vec2> place = Project(read.Camera({i}), glow.centre_world);
      if (!place || (*place - Vec2(120, 80)).cwiseAbs().x() > 110 ||
          (*place - Vec2(120, 80)).cwiseAbs().y() > 70)
        continue;
      EXPECT_NEAR((CentreOfLight(picture, *place) - *place).norm(), 0, 0.1);
      ++seen;
    }
  }
  EXPECT_GT(seen, 200);  // of 77 lamps in each of 4 LF images
}

TEST_F(WriteLightFieldTest, FilesAreTheSameForAnyNumberOfThreads) {
  const BuiltInScene& still_life = *FindBuiltInScene("still-life");
  const Scene scene(still_life.describe());
  LightField light_field = SmallField(still_life, LfImageFormat::kBayer, 48, 32);
  std::vector<std::string> bytes;
  for (const int threads : {1, 3}) {
    ThreadPool pool(threads);
    light_field.folder = folder_ / std::to_string(threads);
    ASSERT_TRUE(WriteLightField(scene, light_field, {LfImageFormat::kBayer, 4, 0.02, 5, {}}, pool));
    for (uint32_t i = 0; i < light_field.size(); ++i)
      bytes.push_back(*ReadFile(light_field.ImagePath({i})));
    bytes.push_back(*ReadFile(light_field.folder / "transforms.json"));
  }
  ASSERT_EQ(bytes.size(), 10U);
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(bytes[i], bytes[i + 5]);
}

// RadianceTable(), with which LF images are loaded, converts the numbers of each PNG format to the
// photographed radiance, clipped at max_radiance.
TEST_F(WriteLightFieldTest, StoredNumbersMeanTheRadiancePhotographed) {
  const BuiltInScene& still_life = *FindBuiltInScene("still-life");
  const Scene scene(still_life.describe());
  for (const LfImageFormat format :
       {LfImageFormat::kPng, LfImageFormat::kPng16, LfImageFormat::kBayer}) {
    const LightField light_field = SmallField(still_life, format, 48, 32);
    ASSERT_TRUE(WriteLightField(scene, light_field, {format, 4, 0, 0, {}}, pool_));
    const RadianceEncoding encoding = ReadTransformsJson(folder_ / "transforms.json")->encoding;
    const Image<float> picture = Photograph(scene, light_field.Camera({0}), 4);
    const StoredImage stored = *ReadImage(light_field.ImagePath({0}));
    const std::vector<uint16_t> table =
        RadianceTable(encoding, format == LfImageFormat::kPng ? 8 : 16, 1);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 48; ++x) {
        const bool mosaic = encoding.bayer != BayerPattern::kNone;
        const int channel = mosaic ? BayerChannel(encoding.bayer, x, y) : (x + y) % 3;
        const double v =
            format == LfImageFormat::kPng
                ? table[std::get<Image<uint8_t>>(stored).at(x, y, channel)]
                : table[std::get<Image<uint16_t>>(stored).at(x, y, mosaic ? 0 : channel)];
        const double radiance = (v - encoding.pedestal) / encoding.Scale() *
                                encoding.white_balance[static_cast<size_t>(channel)];
        const double expected =
            std::min(static_cast<double>(picture.at(x, y, channel)), encoding.max_radiance);
        const double step = format == LfImageFormat::kPng ? 0.003 + 0.008 * expected : 0.002;
        EXPECT_NEAR(radiance, expected, step);
      }
  }
}

TEST_F(WriteLightFieldTest, NoiseHasTheStandardDeviationAskedFor) {
  const RadianceEncoding encoding = EncodingOf(LfImageFormat::kBayer, 4);
  const Image<float> grey(200, 100, 3, 0.5F);
  const Image<uint16_t> mosaic = Mosaic(grey.view(), encoding, 0.05, 7);
  double sum = 0, squares = 0;
  int count = 0;
  const double per_radiance = *encoding.white_level - encoding.black_level;
  for (int y = 0; y < 100; y += 2)
    for (int x = 1; x < 200; x += 2, ++count) {  // green
      const double radiance = (mosaic.at(x, y) - encoding.black_level) / per_radiance;
      sum += radiance;
      squares += radiance * radiance;
    }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0.5, 0.003);
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.05 * std::sqrt(0.51), 0.001);
  EXPECT_NE(mosaic.pixels(), Mosaic(grey.view(), encoding, 0.05, 8).pixels());
}

TEST_F(WriteLightFieldTest, AStoppedCaptureLeavesNoCalibration) {
  const BuiltInScene& lights = *FindBuiltInScene("lights");
  const LightField light_field = SmallField(lights, LfImageFormat::kPng, 24, 16);
  const Scene scene(lights.describe());
  ASSERT_TRUE(WriteLightField(scene, light_field, {LfImageFormat::kPng, 1, 0, 0, {}}, pool_));
  ASSERT_TRUE(std::filesystem::exists(folder_ / "transforms.json"));
  WriteLightFieldOptions options{LfImageFormat::kPng, 1, 0, 0, {}};
  options.keep_going = [](size_t) { return false; };
  ThreadPool one(1);
  const Result<void> stopped = WriteLightField(scene, light_field, options, one);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
  EXPECT_NE(stopped.error().message.find("after 1 of 4 images"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "transforms.json"));
}

TEST_F(WriteLightFieldTest, AFolderThatCannotBeMadeIsNamed) {
  const BuiltInScene& lights = *FindBuiltInScene("lights");
  std::ofstream(folder_ / "taken") << "a file";
  LightField light_field = SmallField(lights, LfImageFormat::kPng, 24, 16);
  light_field.folder = folder_ / "taken";
  const Result<void> written = WriteLightField(Scene(lights.describe()), light_field, {}, pool_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kOutput);
  EXPECT_NE(written.error().message.find("taken"), std::string::npos);
}

}  // namespace
}  // namespace lf
