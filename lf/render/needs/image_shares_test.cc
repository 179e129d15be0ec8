// SPDX-License-Identifier: Apache-2.0
#include "lf/render/needs/image_shares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/render/collect/around_lens.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/test_noise_field.h"

namespace lf {
namespace {

struct Shares {
  double share = 0, squared = 0;
};

// Returns the mean share and the mean squared share of each LF image over all elements of the
// frame, ray by ray.
std::map<uint32_t, Shares> SharesByRays(const ImageIndex& index, const RenderCamera& frame,
                                        LensWeights kind, ThreadPool& pool) {
  const LightField& field = index.light_field();
  const FrameLens lens(index, frame, kind, {}, pool);
  const LensPlane plane(frame);
  const ApertureTest opening(frame.aperture);
  const Intrinsics& k = frame.pinhole.intrinsics;
  std::vector<RayWeights> weights;
  std::vector<RayThrough> rays;
  for (uint32_t i = 0; i < field.size(); ++i) {
    weights.push_back(lens.WeightsOf({i}));
    rays.emplace_back(field.Camera({i}), frame.pinhole.ForwardWorld());
  }
  std::map<uint32_t, Shares> shares;
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      const std::optional<Vec3> focus = FocusPointOfElement(frame, x + 0.5, y + 0.5);
      std::vector<double> of_images(field.size());
      double sum = 0;
      for (uint32_t i = 0; focus && i < field.size(); ++i) {
        if (!IsSeenBy(rays[i], *focus)) continue;
        if (kind == LensWeights::kNone &&
            !opening.Contains(plane.PointOfLine(rays[i].centre_world(), *focus)))
          continue;
        sum += of_images[i] = weights[i].At(x, y);
      }
      for (uint32_t i = 0; i < field.size(); ++i) {
        if (of_images[i] == 0) continue;
        const double share = of_images[i] / sum, part = 1. / (k.width_px * k.height_px);
        shares[i].share += share * part;
        shares[i].squared += share * share * part;
      }
    }
  return shares;
}

TEST(ImageShares, AreThoseOfAllRays) {
  ThreadPool pool(2);
  CameraPath path;
  for (RenderCamera frame : testing::NoiseFrames()) {
    // The frame sees nothing beyond the borders of LF images, where shares change from element to
    // element.
    for (double* value : {&frame.pinhole.intrinsics.fx_px, &frame.pinhole.intrinsics.fy_px})
      *value *= 2;
    path.cameras.push_back(frame);
  }
  const Package package = PackageOfAll(testing::NoiseField(), path, 1);
  const ImageIndex index(package.light_field, package.ranks);
  for (const LensWeights kind :
       {LensWeights::kAuto, LensWeights::kHat, LensWeights::kArea, LensWeights::kNone})
    for (uint32_t frame = 1; frame <= path.cameras.size(); ++frame) {
      const auto expected = SharesByRays(index, path.Camera({frame}), kind, pool);
      double of_all = 0, squared = 0, expected_squared = 0, differences = 0;
      for (const ImageShare& image : SharesOf(index, package, {frame}, kind, pool)) {
        const auto found = expected.find(image.id.value);
        const Shares by_rays = found == expected.end() ? Shares() : found->second;
        of_all += image.share;
        squared += image.squared;
        differences += std::abs(image.squared - by_rays.squared);
      }
      for (const auto& [id, by_rays] : expected) expected_squared += by_rays.squared;
      EXPECT_NEAR(of_all, 1, 1e-9);
      EXPECT_NEAR(squared, expected_squared, 0.05 * expected_squared);
      EXPECT_LT(differences, 0.15 * expected_squared) << NameOf(kind) << ", frame " << frame;
    }
}

// The border of the frame is seen by few LF images, whose shares are then large.
TEST(ImageShares, OfAFrameThatSeesMoreThanLfImagesAreNearlyThoseOfAllRays) {
  ThreadPool pool(2);
  CameraPath path;
  path.cameras = testing::NoiseFrames();
  const Package package = PackageOfAll(testing::NoiseField(), path, 1);
  const ImageIndex index(package.light_field, package.ranks);
  for (uint32_t frame = 1; frame <= path.cameras.size(); ++frame) {
    double squared = 0, expected = 0;
    for (const ImageShare& image : SharesOf(index, package, {frame}, LensWeights::kAuto, pool))
      squared += image.squared;
    for (const auto& [id, of_rays] :
         SharesByRays(index, path.Camera({frame}), LensWeights::kAuto, pool))
      expected += of_rays.squared;
    EXPECT_GT(squared, 0.6 * expected);
    EXPECT_LT(squared, 1.6 * expected);
  }
}

TEST(ImageShares, OfAPackageWithALimitAreThoseOfTheFirstImages) {
  ThreadPool pool(2);
  CameraPath path;
  path.cameras = testing::NoiseFrames();
  Package package = PackageOfAll(testing::NoiseField(), path, 1);
  package.choices.max_image_count = 5;
  const ImageIndex index(package.light_field, package.ranks);
  const std::vector<ImageShare> shares = SharesOf(index, package, {1}, LensWeights::kAuto, pool);
  EXPECT_EQ(shares.size(), 5U);
  double sum = 0;
  for (const ImageShare& image : shares) sum += image.share;
  EXPECT_LE(sum, 1 + 1e-9);
  EXPECT_GT(sum, 0.5);
}

// Each instant counts equally, and an LF image that all of them use has the sum of its weights.
TEST(ImageShares, OfAShutterAreThoseOfItsInstants) {
  ThreadPool pool(2);
  CameraPath path;
  const std::vector<RenderCamera> frames = testing::NoiseFrames();
  path.cameras = {frames[0]};
  Package still = PackageOfAll(testing::NoiseField(), path, 1);
  path.shutter = {180, 2};
  path.instants = {frames[0], frames[0]};
  Package moving = PackageOfAll(testing::NoiseField(), path, 1);
  const ImageIndex index(still.light_field, still.ranks);
  const auto once = SharesOf(index, still, {1}, LensWeights::kAuto, pool);
  const auto twice = SharesOf(index, moving, {1}, LensWeights::kAuto, pool);
  ASSERT_EQ(once.size(), twice.size());
  for (size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].id, twice[i].id);
    EXPECT_NEAR(once[i].squared, twice[i].squared, 1e-9);
  }
}

}  // namespace
}  // namespace lf
