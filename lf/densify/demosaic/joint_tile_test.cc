// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/densify/demosaic/test_mosaics.h"

namespace lf {
namespace {

constexpr PixelRect kWhole{0, 0, DrawnMosaics::kWidth, DrawnMosaics::kHeight};
constexpr double kDepth = 2;

// LF image 0 of some mosaics, with all others as neighbours.
class Merging {
 public:
  explicit Merging(const DrawnMosaics& drawn)
      : other(DemosaickedWithOtherPattern(MakeImages(drawn), drawn.field.encoding)),
        is_tested(TestedOnceInFour()),
        ideal_(images[0].camera),
        depths_(kWhole.width(), kWhole.height(), 1, static_cast<float>(1 / kDepth)) {
    for (size_t i = 1; i < images.size(); ++i) neighbours_.push_back(NeighbourOf(images[i]));
  }

  JointTile Merge(const PixelRect& rect = kWhole) const {
    return MergeTile({images.data(), &ideal_, &depths_, neighbours_, &other, &is_tested}, rect);
  }

  std::vector<JointImage> images;
  Image<float> other;
  Image<uint8_t> is_tested;

 private:
  const JointImage& MakeImages(const DrawnMosaics& drawn) {
    for (uint32_t i = 0; i < drawn.mosaics.size(); ++i) images.push_back(drawn.ImageOf(i));
    return images[0];
  }
  JointNeighbour NeighbourOf(const JointImage& image) const {
    const PixelPlaces places(images[0].camera, image.camera);
    return {&image, places,
            places.OffsetsIn(ideal_, kWhole.width(), kWhole.height(), depths_.at(0, 0)), 1.0F,
            ShiftPerInverseDepth(images[0].camera, image.camera)};
  }
  static Image<uint8_t> TestedOnceInFour() {
    Image<uint8_t> result(kWhole.width(), kWhole.height());
    for (size_t i = 0; i < result.pixels().size(); i += 4) result.pixels()[i + i / 4 % 4] = 1;
    return result;
  }

  IdealPositions ideal_;
  Image<float> depths_;
  std::vector<JointNeighbour> neighbours_;
};

bool AreSame(const Image<float>& a, const Image<float>& b) {
  return std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), b.pixels().end());
}

TEST(JointTile, NeighboursThatRecordedTheMissingColoursRestoreThem) {
  for (const BayerPattern pattern : {BayerPattern::kRggb, BayerPattern::kGbrg}) {
    DrawnMosaics drawn(pattern);
    drawn.AddGrid({{kDepth}});
    const Merging merging(drawn);
    const double single = drawn.ErrorOf(merging.images[0].rgb, 0);
    const double joint = drawn.ErrorOf(merging.Merge().rgb, 0);
    EXPECT_LT(joint, single / 6);
  }
}

TEST(JointTile, DarkMosaicsDisagreeAsBrightOnesDo) {
  DrawnMosaics bright, dark;
  // The depths of the far wall are wrong, so that its neighbours must not count.
  const std::vector<Wall> walls = {{4, INFINITY, 2}, {kDepth, 0}};
  bright.AddGrid(walls);
  dark.AddGrid(walls);
  constexpr double kShare = 1.0 / 30;
  const auto darken = [&](double value) {
    return DrawnMosaics::kNoLight + kShare * (value - DrawnMosaics::kNoLight);
  };
  for (LfPixels& mosaic : dark.mosaics)
    for (uint16_t& value : mosaic.radiance.pixels())
      value = static_cast<uint16_t>(std::lround(darken(value)));
  for (Image<float>& rgb : dark.rgb)
    for (float& value : rgb.pixels()) value *= static_cast<float>(kShare);
  const double error = bright.ErrorOf(Merging(bright).Merge().rgb, 0);
  EXPECT_LT(dark.ErrorOf(Merging(dark).Merge().rgb, 0), 1.6 * kShare * kShare * error);
}

TEST(JointTile, NeighboursMayBeRolled) {
  DrawnMosaics even, rolled;
  even.AddGrid({{kDepth}});
  rolled.Add(CameraAt(0, 0, kWhole.width(), kWhole.height()), {{kDepth}});
  for (size_t i = 1; i < even.field.size(); ++i) {
    PinholeCamera camera = even.field.Camera(LfImageId{static_cast<uint32_t>(i)});
    const Mat3 roll = Eigen::AngleAxisd(i % 2 == 0 ? 0.6 : -0.6, Vec3::UnitZ()).matrix();
    camera.cam_from_world = RigidTransform{roll, Vec3::Zero()} * camera.cam_from_world;
    rolled.Add(camera, {{kDepth}});
  }
  const Merging one(even), other(rolled);
  EXPECT_LT(rolled.ErrorOf(other.Merge().rgb, 0), 1.3 * even.ErrorOf(one.Merge().rgb, 0));
}

TEST(JointTile, RecordedValuesAreKept) {
  DrawnMosaics drawn;
  drawn.AddGrid({{kDepth}});
  const Merging merging(drawn);
  const JointTile tile = merging.Merge();
  const JointImage& image = merging.images[0];
  for (int y = 0; y < kWhole.height(); ++y)
    for (int x = 0; x < kWhole.width(); ++x)
      ASSERT_EQ(tile.rgb.at(x, y, image.ColourAt(x, y)), image.samples.at(x, y));
}

TEST(JointTile, TestedPixelsAreFoundWithoutTheirValues) {
  DrawnMosaics drawn;
  drawn.AddGrid({{kDepth}});
  const Merging merging(drawn);
  const JointTile tile = merging.Merge();
  const JointImage& image = merging.images[0];
  double single = 0, joint = 0;
  size_t equal = 0, count = 0;
  for (int y = 12; y < kWhole.height() - 12; ++y)
    for (int x = 12; x < kWhole.width() - 12; ++x) {
      if (merging.is_tested.at(x, y) == 0) continue;
      const float recorded = image.samples.at(x, y);
      single += std::pow(merging.other.at(x, y, image.ColourAt(x, y)) - recorded, 2);
      joint += std::pow(tile.tested.at(x, y) - recorded, 2);
      equal += tile.tested.at(x, y) == recorded ? 1 : 0;
      ++count;
    }
  EXPECT_LT(joint, single / 2);
  EXPECT_LT(equal, count / 20);
}

TEST(JointTile, NeighboursThatShowSomethingBrighterChangeNothing) {
  DrawnMosaics drawn;
  drawn.AddGrid({{kDepth}}, 3);
  for (size_t i = 1; i < drawn.mosaics.size(); ++i)
    for (uint16_t& value : drawn.mosaics[i].radiance.pixels()) value += 20000;
  const Merging merging(drawn);
  EXPECT_TRUE(AreSame(merging.Merge().rgb, merging.images[0].rgb));
}

TEST(JointTile, TilesAreEqualHoweverTheImageIsCut) {
  DrawnMosaics drawn;
  drawn.AddGrid({{3, INFINITY, 2}, {kDepth, 0}}, 3);
  const Merging merging(drawn);
  const JointTile whole = merging.Merge();
  for (const PixelRect& rect :
       {PixelRect{0, 0, 48, 32}, PixelRect{48, 0, 96, 32}, PixelRect{30, 32, 50, 64}}) {
    const JointTile tile = merging.Merge(rect);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x)
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(tile.rgb.at(x, y, c), whole.rgb.at(rect.x_begin + x, rect.y_begin + y, c))
              << x << " " << y;
  }
}

TEST(JointTile, MaskedPixelsOfNeighboursAreNoSamples) {
  DrawnMosaics drawn;
  drawn.AddGrid({{kDepth}}, 3);
  for (size_t i = 1; i < drawn.mosaics.size(); ++i)
    for (int y = 0; y < kWhole.height(); ++y)
      for (int x = 0; x < kWhole.width(); ++x) {
        drawn.mosaics[i].radiance.at(x, y) = 60000;  // must not be seen
        drawn.mosaics[i].Mask(x, y);
      }
  const Merging merging(drawn);
  EXPECT_TRUE(AreSame(merging.Merge().rgb, merging.images[0].rgb));
}

TEST(JointTile, ClippedValuesOfLongerExposuresAreNoSamples) {
  DrawnMosaics drawn;
  drawn.AddGrid({{kDepth}});
  const double error = drawn.ErrorOf(Merging(drawn).Merge().rgb, 0);
  // The neighbours have gains of a fifth, and record no more than a fifth of white.
  for (size_t i = 1; i < drawn.mosaics.size(); ++i) {
    drawn.field.cameras[i].gain = 0.2F;
    for (uint16_t& value : drawn.mosaics[i].radiance.pixels())
      value = std::min(value, static_cast<uint16_t>(DrawnMosaics::kNoLight +
                                                    0.2 * drawn.field.encoding.Scale()));
  }
  const Merging clipped(drawn);
  const double single = drawn.ErrorOf(clipped.images[0].rgb, 0);
  const double joint = drawn.ErrorOf(clipped.Merge().rgb, 0);
  EXPECT_LT(joint, single);
  EXPECT_GT(joint, error);
}

}  // namespace
}  // namespace lf
