// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/lens_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/densify/densify_plan.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace {

// A frame whose lens is at (x, 0, 0), turned about the upright axis.
RenderCamera Frame(double x, double radius, double turn_deg = 0) {
  RenderCamera frame;
  const double turn = RadiansFromDegrees(turn_deg);
  frame.pinhole = CameraAt(0, 0);
  frame.pinhole.cam_from_world =
      *LookAlong(Vec3(x, 0, 0), Vec3(std::sin(turn), 0, std::cos(turn)), -Vec3::UnitY());
  frame.aperture.radius_w = radius;
  frame.focus_distance_w = 8;
  frame.focus_plane = FocusPlane(frame.pinhole, 8, {});
  return frame;
}

// LF cameras 1 apart, in `rows` rows of 7 around the origin.
LightField Grid(int rows) {
  LightField field;
  field.intrinsics = {CameraAt(0, 0).intrinsics};
  for (int y = 0; y < rows; ++y)
    for (int x = -3; x <= 3; ++x) {
      LfCamera camera;
      camera.cam_from_world = CameraAt(x, y - (rows - 1) / 2.0).cam_from_world;
      field.cameras.push_back(camera);
      field.image_names.emplace_back();
    }
  return field;
}

TEST(SectionsOf, EqualLensesAreOneSection) {
  const std::vector<RenderCamera> frames(5, Frame(0, 0.1));
  ASSERT_EQ(SectionsOf(frames).size(), 1u);
  EXPECT_EQ(SectionsOf(frames)[0].frames.size(), 5u);
  EXPECT_DOUBLE_EQ(SectionsOf(frames)[0].inverse_focus, 0.125);
}

TEST(SectionsOf, ACameraThatTurnsOrMovesAlongItsAxisHasSeveral) {
  std::vector<RenderCamera> turning, along;
  for (int i = 0; i < 10; ++i) {
    turning.push_back(Frame(0, 0.1, 2.0 * i));
    along.push_back(Frame(0, 0.1));
    along.back().pinhole.cam_from_world.translation = Vec3(0, 0, -0.1 * i);
  }
  EXPECT_EQ(SectionsOf(turning).size(), 3u);
  EXPECT_EQ(SectionsOf(along).size(), 10u);
}

TEST(FilmLenses, RecordedOnesAreInALensOrBesideIt) {
  const LightField field = Grid(1);  // at x = -3 ... 3
  const std::vector<RenderCamera> frames = {Frame(0.3, 0.4), Frame(2.5, 0.2)};
  const FilmLenses lenses(field, FarEnoughApart(field, {}), frames);
  EXPECT_EQ(lenses.Recorded(0.1), (std::vector<uint32_t>{3}));
  EXPECT_EQ(lenses.Recorded(0.31), (std::vector<uint32_t>{3, 4, 5, 6}));
}

TEST(FilmLenses, VirtualOnesAreMadeOfThoseThatAreUsed) {
  const LightField field = Grid(5);
  const std::vector<RenderCamera> frames = {Frame(0.3, 0.4)};
  const std::vector<uint32_t> used = {7, 11, 13, 21, 25, 27, 33};
  const FilmLenses lenses(field, used, frames);
  EXPECT_EQ(lenses.Serving(), used);
  const std::vector<LensPlace> places = lenses.Places(0.2, 0.5).places;
  ASSERT_FALSE(places.empty());
  const Vec3 recorded = field.Camera(LfImageId{17}).CentreWorld();  // not used, but in the lens
  for (const LensPlace& place : places) {
    EXPECT_GE((place.centre_world - recorded).norm(), 0.1);
    for (const WeightedPoint& source : lenses.CameraAt(place, 0.2, 1).sources)
      EXPECT_TRUE(std::binary_search(used.begin(), used.end(), source.index));
  }
}

TEST(FilmLenses, LatticesFillTheLensesAndNothingElse) {
  const LightField field = Grid(5);
  const std::vector<RenderCamera> frames = {Frame(0.3, 0.4), Frame(1.2, 0.2)};
  constexpr double kDistance = 0.1;
  const FilmLenses lenses(field, FarEnoughApart(field, {}), frames);
  const LensPlaces found = lenses.Places(kDistance, 0.5);
  EXPECT_EQ(found.filled_radius_w, INFINITY);
  double farthest[2] = {};
  for (const LensPlace& place : found.places) {
    const double first = (place.centre_world - Vec3(0.3, 0, 0)).norm();
    const double second = (place.centre_world - Vec3(1.2, 0, 0)).norm();
    EXPECT_TRUE(first <= 0.5 + 1e-9 || second <= 0.3 + 1e-9);
    EXPECT_NEAR(place.centre_world.z(), 0, 1e-12);
    (first < second ? farthest[0] : farthest[1]) =
        std::max(first < second ? farthest[0] : farthest[1], std::min(first, second));
    for (const LensPlace& other : found.places)
      EXPECT_TRUE(&place == &other ||
                  (place.centre_world - other.centre_world).norm() > 0.999 * kDistance);
    for (uint32_t id = 0; id < field.size(); ++id)
      EXPECT_GE((field.Camera(LfImageId{id}).CentreWorld() - place.centre_world).norm(),
                kDistance / 2);
  }
  EXPECT_GT(farthest[0], 0.4);
  EXPECT_GT(farthest[1], 0.2);
  // A hexagonal lattice has a place for each sqrt(3) / 2 of the squared distance.
  const double cell = 0.866 * kDistance * kDistance;
  EXPECT_NEAR(static_cast<double>(found.places.size()), kPi * (0.25 + 0.09) / cell, 12);
}

TEST(FilmLenses, BesideARowTheLensIsFilledAsFarAsAllowed) {
  const LightField field = Grid(1);
  const std::vector<RenderCamera> frames = {Frame(0, 0.8)};
  const FilmLenses lenses(field, FarEnoughApart(field, {}), frames);
  const LensPlaces found = lenses.Places(0.1, 0.5);
  EXPECT_NEAR(found.filled_radius_w, 0.55, 0.06);
  double highest = 0, farthest = 0;
  for (const LensPlace& place : found.places) {
    highest = std::max(highest, std::abs(place.centre_world.y()));
    farthest = std::max(farthest, std::abs(place.centre_world.x()));
    EXPECT_LE(place.Beyond(), 0.5 + 1e-3);
  }
  EXPECT_GT(highest, 0.4);
  EXPECT_LE(highest, 0.501);
  EXPECT_GT(farthest, 0.7);
}

TEST(DropBeyond, LeavesWhatIsBetweenLfCamerasAndSaysWhatIsFilled) {
  const std::vector<RenderCamera> frames = {Frame(0, 0.8)};
  DensifyPlan plan;
  plan.is_film = true;
  for (const double y : {0.0, 0.3, 0.5, 0.9}) {
    plan.virtual_cameras.emplace_back();
    plan.virtual_cameras.back().camera = CameraAt(0, y);
    plan.virtual_cameras.back().is_beyond = y > 0.1;
  }
  DropBeyond(frames, &plan);
  EXPECT_EQ(plan.virtual_cameras.size(), 1u);
  EXPECT_NEAR(plan.filled_radius_w, 0.3, 1e-12);
}

TEST(FilmLenses, ThePictureOfAPlaceHoldsThatOfTheFrame) {
  const LightField field = Grid(5);
  const std::vector<RenderCamera> frames = {Frame(0.3, 0.4, 3)};
  const FilmLenses lenses(field, FarEnoughApart(field, {}), frames);
  for (const LensPlace& place : lenses.Places(0.1, 0.5).places) {
    const VirtualCamera camera = lenses.CameraAt(place, 0.1, 1);
    EXPECT_NEAR((camera.camera.CentreWorld() - place.centre_world).norm(), 0, 1e-12);
    const Intrinsics& k = frames[0].pinhole.intrinsics;
    for (const double x : {0.0, double(k.width_px)})
      for (const double y : {0.0, double(k.height_px)}) {
        const auto at = Project(camera.camera, *FocusPointOfElement(frames[0], x, y));
        ASSERT_TRUE(at);
        EXPECT_GE(at->x(), 1);
        EXPECT_GE(at->y(), 1);
        EXPECT_LE(at->x(), camera.camera.intrinsics.width_px - 1);
        EXPECT_LE(at->y(), camera.camera.intrinsics.height_px - 1);
      }
    double sum = 0;
    for (const WeightedPoint& source : camera.sources) sum += source.weight;
    EXPECT_EQ(camera.sources.size(), 6u);
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(FilmLenses, NearLfCamerasServe) {
  const LightField field = Grid(9);
  const std::vector<RenderCamera> frames = {Frame(0, 0.4)};
  const std::vector<uint32_t> serving =
      FilmLenses(field, FarEnoughApart(field, {}), frames).Serving();
  EXPECT_EQ(serving.size(), FilmLenses::kServing);
  for (const uint32_t id : serving) EXPECT_LE(field.Camera(LfImageId{id}).CentreWorld().norm(), 3);
}

}  // namespace
}  // namespace lf
