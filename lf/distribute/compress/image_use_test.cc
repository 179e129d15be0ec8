// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/image_use.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace lf {
namespace {

constexpr PixelRect kImage = {0, 0, 100, 80};

// Returns the use of LF images 0, 1, ... by one frame, by their squared shares.
ImageUse UseOf(const std::vector<float>& squared) {
  ImageUse use;
  use.frames.push_back({FrameId{1}, {}});
  for (uint32_t i = 0; i < squared.size(); ++i)
    use.frames[0].shares.push_back({i, std::sqrt(squared[i]), squared[i]});
  return use;
}

TEST(ThresholdFactors, FollowFromTheUseAndAreLimited) {
  // The mean of the used ones is 0.04.
  const std::vector<PixelRect> rects(5, kImage);
  const ThresholdFactors factors(UseOf({0.16F, 0.04F, 0.0002F, 0, 0.0002F}), rects);
  const double mean = (0.16 + 0.04 + 0.0004) / 5;
  EXPECT_NEAR(factors.Of(0), std::sqrt(mean / 0.16), 0.05 * factors.Of(0));
  EXPECT_NEAR(factors.Of(1), std::sqrt(mean / 0.04), 0.05 * factors.Of(1));
  EXPECT_EQ(factors.Of(2), 2);
  EXPECT_EQ(factors.Of(3), 2);
  const ThresholdFactors limited(UseOf({0.9F, 0.001F, 0.001F, 0.001F, 0.001F}), rects);
  EXPECT_EQ(limited.Of(0), 0.5);
  EXPECT_NE(factors.Words(), limited.Words());
  EXPECT_EQ(factors.Words().find(" by use "), 0U);
}

TEST(ThresholdFactors, AreOneForEqualUseAndByDefault) {
  const ThresholdFactors equal(UseOf({0.1F, 0.1F, 0.1F}), std::vector<PixelRect>(3, kImage));
  for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(equal.Of(i), 1);
  EXPECT_TRUE(ThresholdFactors().are_one());
  EXPECT_EQ(ThresholdFactors().Of(7), 1);
  EXPECT_EQ(ThresholdFactors().Words(), "");
}

// An LF image of which few pixels are encoded may have many bits for each.
TEST(ThresholdFactors, CountTheEncodedPixels) {
  const ThresholdFactors factors(UseOf({0.1F, 0.1F}),
                                 std::vector<PixelRect>{kImage, {0, 0, 50, 40}});
  EXPECT_NEAR(factors.Of(0) / factors.Of(1), 2, 0.1);
}

TEST(PredictFrames, AddsOwnAndCommonErrors) {
  ImageUse use = UseOf({0.25F, 0.25F});  // both shares are 1/2
  use.frames.push_back({FrameId{2}, {{0, 1, 1}}});
  const FrameErrors errors = PredictFrames(use, std::vector<double>{0.01, 0.01});
  const double both = (1 - kCommonShare) * 0.005 + kCommonShare * 0.01;
  EXPECT_NEAR(errors.worst, 0.01, 1e-9);
  EXPECT_EQ(errors.worst_frame, FrameId{2});
  EXPECT_NEAR(errors.mean, (both + 0.01) / 2, 1e-9);
}

// Returns a package of a film of three frames, and nine LF cameras 1 apart that look along z.
Package PackageOfThree() {
  LightField field;
  field.intrinsics = {{100, 100, 50, 40, 0, 100, 80}};
  CameraPath path;
  RenderCamera frame;
  frame.pinhole.intrinsics = field.intrinsics[0];
  for (int i = 0; i < 9; ++i) {
    LfCamera camera;
    camera.cam_from_world = *LookAlong({i % 3 - 1., i / 3 - 1., 0}, {0, 0, 1}, {0, -1, 0});
    field.cameras.push_back(camera);
    field.image_names.push_back("image " + std::to_string(i));
  }
  for (int i = 0; i < 3; ++i) {
    frame.pinhole.cam_from_world = *LookAlong({0.2 * i, 0, 0}, {0, 0, 1}, {0, -1, 0});
    frame.aperture = {1.5, 0, 0};
    frame.focus_plane = FocusPlane(frame.pinhole, 10, {0, 0});
    path.cameras.push_back(frame);
  }
  return PackageOfAll(std::move(field), std::move(path), 1);
}

TEST(UseBy, PackagesWithoutWeightsAreRefused) {
  ThreadPool pool(1);
  Package package = PackageOfThree();
  package.images.resize(package.light_field.size());
  for (uint32_t i = 0; i < package.images.size(); ++i) package.images[i] = {i, 1, kImage, 1, 1};
  const Result<ImageUse> use = UseBy(std::span(&package, 1), pool, nullptr);
  ASSERT_TRUE(use);
  EXPECT_EQ(use->frames.size(), 3U);
  EXPECT_EQ(use->films.lens_weights, "auto");
  EXPECT_EQ(use->films.lenses.size(), 1U);
  package.choices.mode = RenderMode::kHybrid;
  const Result<ImageUse> refused = UseBy(std::span(&package, 1), pool, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  package.choices.mode = RenderMode::kCollect;
  Package equal = package;
  equal.choices.has_neighbours = false;
  EXPECT_EQ(UseBy(std::span(&equal, 1), pool, nullptr)->films.lens_weights, "none");
  const std::vector<Package> mixed = {package, equal};
  EXPECT_FALSE(UseBy(mixed, pool, nullptr));
}

}  // namespace
}  // namespace lf
