// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/synthesis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/densify/bicubic.h"
#include "lf/densify/synthesis_row.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace {

constexpr InverseDepths kScene = {0.1, 1.1};
constexpr double kTolerance = 0.05;

// Four cameras around a place in the middle, with true depths.
struct FourSources {
  std::vector<WorkingImage> images;
  std::vector<DepthPlane> planes;
  std::vector<Source> sources;

  explicit FourSources(const std::vector<Wall>& walls) {
    for (const double y : {-0.1, 0.1})
      for (const double x : {-0.1, 0.1}) {
        images.push_back(ImageOfWalls(CameraAt(x, y), walls));
        planes.push_back(TrueDepths(images.back().camera, walls));
      }
    for (size_t i = 0; i < images.size(); ++i) sources.push_back({&images[i], &planes[i], 0.25f});
  }

  static DepthPlane TrueDepths(const PinholeCamera& camera, const std::vector<Wall>& walls) {
    DepthPlane plane(camera.intrinsics.width_px, camera.intrinsics.height_px);
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) {
        Vec3 point;
        plane.at(x, y) =
            kScene.NumberOf(1 / WallAt(camera, walls, x + 0.5, y + 0.5, &point)->depth);
      }
    return plane;
  }
};

// Returns the PSNR of the pixels that are at least `border` away from the border of the image.
double PsnrInside(const Image<uint16_t>& a, const Image<uint16_t>& b, int border) {
  double squares = 0;
  int count = 0;
  for (int y = border; y < a.height() - border; ++y)
    for (int x = border; x < a.width() - border; ++x)
      for (int c = 0; c < 3; ++c, ++count) {
        const double error = (a.at(x, y, c) - b.at(x, y, c)) / 65535.0;
        squares += error * error;
      }
  return -10 * std::log10(squares / count);
}

TEST(Synthesis, ShowsAWallAsARecordedImageWould) {
  const std::vector<Wall> walls = {{2.3, INFINITY, 1}};
  const FourSources four(walls);
  const PinholeCamera camera = CameraAt(0.013, -0.021);
  const VirtualImage image = Synthesize(camera, four.sources, kScene, kTolerance);
  EXPECT_GT(PsnrInside(image.light, ImageOfWalls(camera, walls).light, 8), 42);
  EXPECT_LT(image.weak_share, 0.02);
}

TEST(Synthesis, ShowsBothSidesOfAnOutline) {
  const std::vector<Wall> walls = {{1.5, 0.1, 1}, {6, INFINITY, 2}};
  const FourSources four(walls);
  const PinholeCamera camera = CameraAt(0.013, -0.021);
  const VirtualImage image = Synthesize(camera, four.sources, kScene, kTolerance);
  EXPECT_GT(PsnrInside(image.light, ImageOfWalls(camera, walls).light, 10), 33);
}

// Returns the mean trust in the pixels at least `border` away from the border.
double MeanTrust(const VirtualImage& image, int border) {
  double sum = 0;
  int count = 0;
  for (int y = border; y < image.trust.height() - border; ++y)
    for (int x = border; x < image.trust.width() - border; ++x, ++count)
      sum += image.trust.at(x, y) / 255.0;
  return sum / count;
}

TEST(Synthesis, TrustsPixelsOnWhoseDepthAndColourSourcesAgree) {
  const std::vector<Wall> walls = {{2.3, INFINITY, 1}};
  const PinholeCamera camera = CameraAt(0.013, -0.021);
  const FourSources right(walls);
  EXPECT_GT(MeanTrust(Synthesize(camera, right.sources, kScene, kTolerance), 8), 0.8);
  // Two of the sources have another depth.
  FourSources split(walls);
  for (size_t i = 0; i < 2; ++i)
    split.planes[i] = FourSources::TrueDepths(split.images[i].camera, {{1.2, INFINITY, 1}});
  EXPECT_LT(MeanTrust(Synthesize(camera, split.sources, kScene, kTolerance), 8), 0.5);
  // All have the same depth, but two show another picture there.
  FourSources other(walls);
  for (size_t i = 0; i < 2; ++i)
    other.images[i] = ImageOfWalls(other.images[i].camera, {{2.3, INFINITY, 2}});
  EXPECT_LT(MeanTrust(Synthesize(camera, other.sources, kScene, kTolerance), 8), 0.5);
}

TEST(Synthesis, HasTheSameBitsOnAllInstructionSets) {
  FourSources four({{1.5, 0.1, 1}, {6, INFINITY, 2}});
  four.images[2].light.at(40, 30, 3) = 0;  // a masked pixel
  const PinholeCamera camera = CameraAt(0.013, -0.021, 101, 64);
  const VirtualImage expected = Synthesize(camera, four.sources, kScene, kTolerance);
  // The memory has had an image of another size.
  SynthesisMemory memory;
  Synthesize(CameraAt(0, 0, 120, 70), four.sources, kScene, kTolerance, nullptr, &memory);
  ForEachTarget([&] {
    const VirtualImage& image =
        Synthesize(camera, four.sources, kScene, kTolerance, nullptr, &memory);
    EXPECT_EQ(image.light.pixels(), expected.light.pixels());
    EXPECT_EQ(image.trust.pixels(), expected.trust.pixels());
    EXPECT_EQ(image.weak_share, expected.weak_share);
  });
}

TEST(SynthesisRow, InterpolatesAsBicubicSamples) {
  const WorkingImage image = ImageOfWalls(CameraAt(0, 0), {{2.3, INFINITY, 1}});
  Image<uint16_t> light = image.light;
  light.at(50, 20, 3) = 0;
  SeenPoints seen;
  std::vector<int> pixels;
  for (int i = 0; i < kChunk; ++i) {
    const auto k = static_cast<float>(i);
    seen.u_px[i] = i % 5 == 0 ? 0.2f : 46 + 0.13f * k;
    seen.v_px[i] = i % 7 == 0 ? 63.4f : 18 + 0.07f * k;
    seen.pixel[i] = i == 9 ? kOutside : 0;
    if (i % 3 != 2) pixels.push_back(i);
  }
  ForEachTarget([&] {
    PointColours colours;
    SampleRow(light, true, seen, pixels, &colours);
    for (const int i : pixels) {
      float expected[LfPixels::kRgbLanes];
      const bool is_shown = SampleBicubic(light, seen.u_px[i], seen.v_px[i], expected);
      ASSERT_EQ(colours.is_shown[i], is_shown && i != 9) << i;
      for (int c = 0; colours.is_shown[i] && c < LfPixels::kRgbLanes; ++c)
        EXPECT_NEAR(colours.lanes[i][c], expected[c], 0.05f) << i;
    }
  });
}

TEST(Synthesis, AVirtualCameraAtARecordedOneShowsItsImage) {
  const std::vector<Wall> walls = {{1.5, 0.1, 1}, {6, INFINITY, 2}};
  const FourSources four(walls);
  const Source only[] = {{&four.images[0], &four.planes[0], 1}};
  const VirtualImage image = Synthesize(four.images[0].camera, only, kScene, kTolerance);
  for (int y = 0; y < image.light.height(); ++y)
    for (int x = 0; x < image.light.width(); ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(image.light.at(x, y, c), four.images[0].light.at(x, y, c), 64) << x << " " << y;
}

TEST(Synthesis, OneWrongSourceOfFourIsOutvoted) {
  const std::vector<Wall> walls = {{2.3, INFINITY, 1}};
  FourSources four(walls);
  const PinholeCamera camera = CameraAt(0, 0);
  std::fill(four.planes[2].pixels().begin(), four.planes[2].pixels().end(), kScene.NumberOf(1));
  const VirtualImage image = Synthesize(camera, four.sources, kScene, kTolerance);
  EXPECT_GT(PsnrInside(image.light, ImageOfWalls(camera, walls).light, 10), 40);
}

TEST(Synthesis, PixelsThatNoSourceShowsAreMasked) {
  const std::vector<Wall> walls = {{2.3, INFINITY, 1}};
  const FourSources four(walls);
  PinholeCamera camera = CameraAt(0, 0);
  camera.cam_from_world.rotation = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
  const VirtualImage image = Synthesize(camera, four.sources, kScene, kTolerance);
  int masked = 0, shown = 0;
  for (int y = 0; y < image.light.height(); ++y)
    for (int x = 0; x < image.light.width(); ++x) {
      const bool is_shown = image.light.at(x, y, 3) != 0;
      ++(is_shown ? shown : masked);
      if (!is_shown) {
        EXPECT_EQ(image.light.at(x, y, 0), 0);
      }
    }
  EXPECT_GT(masked, 1000);
  EXPECT_GT(shown, 1000);
}

// Four cameras that see a disk in front of nothing, with true depths; those of transparent pixels
// are wrong.
struct FourOfDisk {
  Disk disk;
  std::vector<WorkingImage> images;
  std::vector<DepthPlane> planes;
  std::vector<Source> sources;

  explicit FourOfDisk(const Disk& of_disk) : disk(of_disk) {
    for (const double y : {-0.1, 0.1})
      for (const double x : {-0.1, 0.1}) {
        images.push_back(ImageOfDisk(CameraAt(x, y), disk));
        DepthPlane plane(images.back().width(), images.back().height());
        for (int v = 0; v < plane.height(); ++v)
          for (int u = 0; u < plane.width(); ++u)
            plane.at(u, v) = IsTransparent(&images.back().tones.at(u, v))
                                 ? kScene.NumberOf(u % 2 == 0 ? 1.1 : 0.1)
                                 : kScene.NumberOf(1 / disk.depth);
        planes.push_back(std::move(plane));
      }
    for (size_t i = 0; i < images.size(); ++i) sources.push_back({&images[i], &planes[i], 0.25f});
  }

  // Expects the disk with its outline, and nothing around it.
  void ExpectDiskAt(const PinholeCamera& camera) const {
    const VirtualImage image = Synthesize(camera, sources, kScene, kTolerance);
    const WorkingImage expected = ImageOfDisk(camera, disk);
    EXPECT_GT(PsnrInside(image.light, expected.light, 4), 38);
    double most = 0;
    for (int y = 4; y < image.light.height() - 4; ++y)
      for (int x = 4; x < image.light.width() - 4; ++x) {
        const uint16_t* pixel = &image.light.at(x, y);
        const double inside_px = InsidePx(camera, disk, x, y);
        most = std::max(most, std::abs(static_cast<double>(pixel[3]) - expected.light.at(x, y, 3)));
        if (inside_px > 3) {
          ASSERT_EQ(pixel[3], kOpaqueOpacity) << x << " " << y;
        }
        if (inside_px < -2) {
          for (int c = 0; c < 4; ++c) ASSERT_EQ(pixel[c], c < 3 ? 0 : 1) << x << " " << y;
          ASSERT_EQ(image.trust.at(x, y), LfPixels::kTrusted) << x << " " << y;
        }
      }
    EXPECT_LT(most, 0.25 * kMostOpacity);
  }
};

TEST(SynthesisOfOpacity, ShowsADiskInFrontOfNothing) {
  const FourOfDisk four({});
  four.ExpectDiskAt(CameraAt(0.013, -0.021));
  four.ExpectDiskAt(CameraAt(-0.06, 0.04));
}

TEST(SynthesisOfOpacity, AnOutlineHasTheColourOfTheObject) {
  const FourOfDisk four({2, 0.3, 0.6, false});
  const VirtualImage image = Synthesize(CameraAt(0.013, -0.021), four.sources, kScene, kTolerance);
  int partly = 0;
  for (int y = 0; y < image.light.height(); ++y)
    for (int x = 0; x < image.light.width(); ++x) {
      const uint16_t* pixel = &image.light.at(x, y);
      const double opacity = (pixel[3] - 1.0) / kMostOpacity;
      if (opacity > 0 && opacity < 1) ++partly;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(pixel[c], 0.6 * 65535 * opacity, 3) << x << " " << y << " " << opacity;
    }
  EXPECT_GT(partly, 50);
}

TEST(SynthesisOfOpacity, SilhouettesOfOtherSourcesRemoveWrongDepths) {
  FourOfDisk four({});
  // At this depth the disk would be 10 px beside its place.
  for (uint16_t& number : four.planes[0].pixels()) number = kScene.NumberOf(1.1);
  four.ExpectDiskAt(CameraAt(0.013, -0.021));
}

TEST(SynthesisOfOpacity, ASmallErrorOfDepthsLeavesTheInsideOpaque) {
  FourOfDisk four({2, 0.3, 0.6, false});
  for (size_t i = 0; i < four.planes.size(); ++i)
    for (uint16_t& number : four.planes[i].pixels()) number = kScene.NumberOf(0.57);
  const PinholeCamera camera = CameraAt(0, 0);
  const VirtualImage image = Synthesize(camera, four.sources, kScene, kTolerance);
  int partly = 0;
  for (int y = 0; y < image.light.height(); ++y)
    for (int x = 0; x < image.light.width(); ++x)
      if (InsidePx(camera, four.disk, x, y) > 0.8 && image.light.at(x, y, 3) < 0.98 * 65535)
        ++partly;
  EXPECT_LT(partly, 44);
}

TEST(SynthesisOfOpacity, MaskedPixelsOfASourceAreUnknownAndRemoveNothing) {
  FourOfDisk four({});
  WorkingImage& image = four.images[1];
  std::fill(image.light.pixels().begin(), image.light.pixels().end(), uint16_t{0});
  std::fill(image.tones.pixels().begin(), image.tones.pixels().end(), uint16_t{0});
  image.empty = EmptyPixels(image.tones);
  image.without_depth = PixelsWithoutDepth(image.tones);
  EXPECT_TRUE(image.empty.empty());
  four.ExpectDiskAt(CameraAt(0.013, -0.021));
}

}  // namespace
}  // namespace lf
