// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/mosaic_share.h"

#include <gtest/gtest.h>

#include <vector>

#include "lf/collection/prefilter/mosaic_correction.h"
#include "lf/core/random.h"

namespace lf {
namespace {

constexpr double kFocal_px = 100;

// Parallel LF cameras at these positions, in pixels of disparity at the distance 1.
LightField FieldAt(const std::vector<Vec2>& places_px) {
  LightField field;
  field.intrinsics = {{kFocal_px, kFocal_px, 80, 80, 0, 160, 160}};
  for (const Vec2& place : places_px) {
    LfCamera camera;
    const Vec3 centre_world(place.x() / kFocal_px, place.y() / kFocal_px, 0);
    camera.cam_from_world =
        *LookAlong({centre_world.x(), centre_world.y(), 0}, {0, 0, 1}, {0, -1, 0});
    field.cameras.push_back(camera);
    field.image_names.push_back("image");
  }
  return field;
}

// Returns the share in a frame at the origin whose lens takes all LF cameras.
double ShareAt(const std::vector<Vec2>& places_px, double focus_w = 1,
               LensWeights kind = LensWeights::kNone) {
  ThreadPool pool(1);
  const LightField field = FieldAt(places_px);
  RenderCamera frame;
  frame.pinhole.intrinsics = {71.3, 71.3, 32.1, 32.3, 0, 64, 64};
  frame.pinhole.cam_from_world = *LookAlong({0, 0, 0}, {0, 0, 1}, {0, -1, 0});
  frame.aperture = {0.5, 0, 0};
  frame.focus_plane = FocusPlane(frame.pinhole, focus_w, {});
  const ImageIndex index(field);
  const std::vector<FrameLens> lenses = LensesOf(index, {&frame, 1}, kind, SelectOptions(), pool);
  std::vector<LfImageId> images;
  for (uint32_t i = 0; i < field.size(); ++i) images.push_back({i});
  return MosaicShareOf(lenses, images);
}

std::vector<Vec2> Grid(int side, double step_px) {
  std::vector<Vec2> places;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) places.emplace_back(x * step_px, y * step_px);
  return places;
}

TEST(MosaicShare, OneLfImageLeavesTheWholeError) {
  EXPECT_NEAR(ShareAt({{0.3, 0.7}}), 1, 1e-9);
  EXPECT_EQ(ShareAt({}), 1);
}

// Neighbours see a point of the focus plane a whole number of patterns apart.
TEST(MosaicShare, LfImagesOfOnePlaceLeaveTheWholeError) {
  EXPECT_NEAR(ShareAt(Grid(6, 2)), 1, 1e-9);
  EXPECT_NEAR(ShareAt(Grid(6, 4), 2), 1, 1e-9);
}

// Neighbours see a point at the four places of the pattern in turn.
TEST(MosaicShare, LfImagesOfAllPlacesLeaveNothing) {
  EXPECT_NEAR(ShareAt(Grid(6, 1)), 0, 1e-9);
  EXPECT_NEAR(ShareAt(Grid(6, 2), 2), 0, 1e-9);
}

TEST(MosaicShare, OfRandomPlacesIsOneByTheirNumber) {
  for (const int count : {10, 100, 1000}) {
    std::vector<Vec2> places;
    for (int i = 0; i < count; ++i)
      places.emplace_back(20 * RandomUnit(3, 0, static_cast<uint64_t>(i)),
                          20 * RandomUnit(3, 1, static_cast<uint64_t>(i)));
    EXPECT_NEAR(ShareAt(places) * count, 1, 0.5) << count;
    EXPECT_NEAR(ShareAt(places, 1, LensWeights::kArea) * count, 1.5, 1) << count;
  }
}

TEST(MosaicShare, ASmallerShareAllowsAStrongerCorrection) {
  EXPECT_EQ(CorrectionFor(1), 0);
  EXPECT_EQ(CorrectionFor(1e-9), kStrongestCorrection);
  int before = 0;
  for (double share = 1; share > 1e-4; share *= 0.9) {
    EXPECT_GE(CorrectionFor(share), before);
    EXPECT_LE(CorrectionFor(share), before + 1);
    before = CorrectionFor(share);
  }
}

}  // namespace
}  // namespace lf
