// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/plane_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr int kSide = 64;
constexpr double kFocal_px = 64;

PinholeCamera CameraAt(double x, double y) {
  PinholeCamera camera;
  camera.intrinsics = {kFocal_px, kFocal_px, kSide / 2.0, kSide / 2.0, 0, kSide, kSide};
  camera.cam_from_world.translation = {-x, -y, 0};
  return camera;
}

RenderCamera Frame() {
  RenderCamera frame;
  frame.pinhole = CameraAt(0, 0);
  return frame;
}

// Light, from 0 to 1, that is seen from a position in a direction (x, y, 1).
using World = std::function<double(const Vec2& position, const Vec2& direction)>;

double Texture(double x, double y) {
  return 0.5 + 0.2 * std::sin(31 * x + 17 * y) + 0.2 * std::sin(23 * y - 13 * x + 1);
}

// Views of a world from a grid of 7 x 7 positions in a lens of radius 0.1.
std::vector<LensView> ViewsOf(const World& world, double noise = 0) {
  std::vector<LensView> views;
  for (int v = -3; v <= 3; ++v)
    for (int u = -3; u <= 3; ++u) {
      const Vec2 position(u / 30.0, v / 30.0);
      LensView view;
      view.of.id = LfImageId{static_cast<uint32_t>(views.size())};
      view.of.lens_point = {position.x(), -position.y()};
      view.camera = CameraAt(position.x(), position.y());
      view.rect = {0, 0, kSide, kSide};
      view.light = Image<uint16_t>(kSide, kSide, 4, 1);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const Vec2 direction((x + 0.5 - kSide / 2.0) / kFocal_px,
                               (y + 0.5 - kSide / 2.0) / kFocal_px);
          const double random = RandomUnit(views.size(), static_cast<uint64_t>(y * kSide + x), 0);
          const double light = world(position, direction) + noise * (random - 0.5);
          for (int c = 0; c < 3; ++c)
            view.light.at(x, y, c) =
                static_cast<uint16_t>(std::lround(65535 * std::clamp(light, 0.0, 1.0)));
        }
      views.push_back(std::move(view));
    }
  return views;
}

// A textured plane at a distance.
World PlaneAt(double distance) {
  return [distance](const Vec2& position, const Vec2& direction) {
    const Vec2 point = position + distance * direction;
    return Texture(point.x() / distance, point.y() / distance);
  };
}

// Distances from 1 to 4 between which a point moves by about half an element at the rim.
SweepOptions Options() {
  SweepOptions options;
  for (int i = 0; i < 12; ++i) options.distances_w.push_back(1 / (1.05 - 0.08 * i));
  return options;
}

double DistanceAt(double index) { return 1 / (1.05 - 0.08 * index); }

std::vector<SweptDepth> Swept(const std::vector<LensView>& views, const SweepOptions& options,
                              const PixelRect& tile = {16, 16, 48, 48}) {
  std::vector<SweptDepth> depths;
  SweepTile(views, Frame(), options, tile, &depths);
  EXPECT_EQ(depths.size(), static_cast<size_t>(tile.pixel_count()));
  return depths;
}

TEST(PlaneSweep, FindsATexturedPlane) {
  const SweepOptions options = Options();
  for (const double distance : {1.2, 1.7, 2.6}) {
    size_t sure = 0;
    const auto depths = Swept(ViewsOf(PlaneAt(distance)), options);
    for (const SweptDepth& depth : depths) {
      if (depth.confidence < 0.5) continue;
      ++sure;
      EXPECT_NEAR(1 / DistanceAt(depth.index), 1 / distance, 0.08 / 4) << distance;
    }
    EXPECT_GT(sure, depths.size() * 9 / 10);
  }
}

TEST(PlaneSweep, AFlatWallHasNoDepth) {
  for (const double noise : {0.0, 0.003, 0.05})
    for (const SweptDepth& depth :
         Swept(ViewsOf([](const Vec2&, const Vec2&) { return 0.4; }, noise), Options()))
      EXPECT_LT(depth.confidence, 0.5) << noise;
}

TEST(PlaneSweep, SurfacesBeyondTheDistancesHaveNoDepth) {
  size_t sure = 0;
  for (const SweptDepth& depth : Swept(ViewsOf(PlaneAt(0.6)), Options()))
    sure += depth.confidence >= 0.5 ? 1 : 0;
  EXPECT_LT(sure, 32u * 32 / 50);
}

// A near plane hides what lies to the left of the middle. Beside its border, the far plane is seen
// from the right half of the lens alone.
TEST(PlaneSweep, BesideANearSurfaceTheFarOneIsFound) {
  constexpr double kNear = 1.2, kFar = 2.6;
  const World world = [](const Vec2& position, const Vec2& direction) {
    const bool is_near = position.x() + kNear * direction.x() < 0;
    return (is_near ? PlaneAt(kNear) : PlaneAt(kFar))(position, direction);
  };
  const SweepOptions options = Options();
  const auto depths = Swept(ViewsOf(world), options, {34, 16, 40, 48});
  size_t right = 0, wrong = 0;
  for (size_t i = 0; i < depths.size(); ++i) {
    if (depths[i].confidence < 0.5) continue;
    const bool is_far = std::abs(1 / DistanceAt(depths[i].index) - 1 / kFar) < 0.08;
    ++(is_far ? right : wrong);
  }
  EXPECT_GT(right, depths.size() / 2);
  EXPECT_LT(wrong, depths.size() / 20);
}

TEST(PlaneSweep, TheOrderOfTheViewsChangesNoBit) {
  std::vector<LensView> views = ViewsOf(PlaneAt(1.7), 0.02);
  const auto depths = Swept(views, Options());
  std::reverse(views.begin(), views.end());
  std::swap(views[3], views[17]);
  const auto others = Swept(views, Options());
  for (size_t i = 0; i < depths.size(); ++i) {
    EXPECT_EQ(depths[i].index, others[i].index);
    EXPECT_EQ(depths[i].confidence, others[i].confidence);
  }
}

TEST(PlaneSweep, TilesAndLoadedPartsChangeNoBit) {
  const std::vector<LensView> views = ViewsOf(PlaneAt(1.7), 0.02);
  const auto whole = Swept(views, Options(), {0, 0, 64, 64});
  std::vector<LensView> parts;
  for (const LensView& view : views) {
    LensView part = view;
    part.rect = {3, 9, 61, 58};
    part.light = Image<uint16_t>(part.rect.width(), part.rect.height(), 4);
    for (int y = 0; y < part.light.height(); ++y)
      for (int x = 0; x < part.light.width(); ++x)
        for (int c = 0; c < 4; ++c) part.light.at(x, y, c) = view.light.at(x + 3, y + 9, c);
    parts.push_back(std::move(part));
  }
  const auto tile = Swept(parts, Options(), {24, 24, 40, 40});
  for (int y = 24; y < 40; ++y)
    for (int x = 24; x < 40; ++x) {
      const SweptDepth& a = whole[static_cast<size_t>(y * 64 + x)];
      const SweptDepth& b = tile[static_cast<size_t>((y - 24) * 16 + x - 24)];
      EXPECT_EQ(a.confidence, b.confidence);
      EXPECT_EQ(a.index, b.index);
    }
}

TEST(PlaneSweep, MaskedPixelsAndTooFewViewsHaveNoCost) {
  std::vector<LensView> views = ViewsOf(PlaneAt(1.7));
  for (LensView& view : views) {
    view.any_masked = true;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        for (int c = 0; c < 4; ++c) view.light.at(x, y, c) = 0;
  }
  for (const SweptDepth& depth : Swept(views, Options())) EXPECT_LT(depth.index, 0);
  views.resize(kLeastViews - 1);
  for (const SweptDepth& depth : Swept(views, Options())) EXPECT_LT(depth.index, 0);
}

}  // namespace
}  // namespace lf
