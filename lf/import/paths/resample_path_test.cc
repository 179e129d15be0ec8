// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/resample_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/path/test_path.h"
#include "lf/camera/path/view_cameras.h"

namespace lf {
namespace {

CameraPath MovingPath() {
  const Result<CameraPath> path =
      TestPath{.clock = "fps: 10\nframes: 11\nresolution: [200, 100]\n",
               .pose =
                   "position: [0, 0, -2], speed: [1, 0, 0], orientation: {yaw: 0}, "
                   "orientation_speed: {yaw: 20}",
               .focus = "focus_distance: 2, focus_distance_speed: 1"}
          .Parse();
  EXPECT_TRUE(path) << path.error().message;
  return path ? *path : CameraPath{};
}

// Expects the camera of MovingPath() at a time.
void ExpectMovedTo(const RenderCamera& camera, double time_s) {
  EXPECT_LT((camera.pinhole.CentreWorld() - Vec3(time_s, 0, -2)).norm(), 1e-9) << time_s;
  const double yaw_rad = RadiansFromDegrees(20 * time_s);
  EXPECT_LT((camera.pinhole.ForwardWorld() - Vec3(std::sin(yaw_rad), 0, std::cos(yaw_rad))).norm(),
            1e-9);
  EXPECT_NEAR(camera.focus_distance_w, 2 + time_s, 1e-9);
  EXPECT_NEAR(
      camera.focus_plane.normal.dot(camera.pinhole.CentreWorld() +
                                    camera.focus_distance_w * camera.pinhole.ForwardWorld()),
      camera.focus_plane.offset_w, 1e-9);
}

TEST(ResamplePath, AnotherRateKeepsTheDuration) {
  const CameraPath path = MovingPath();
  const Result<CameraPath> fine = ResamplePath(path, 24, std::nullopt);
  ASSERT_TRUE(fine);
  EXPECT_EQ(fine->fps, 24);
  ASSERT_EQ(fine->frame_count(), 25u);
  for (size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(fine->cameras[i].time_s, static_cast<double>(i) / 24);
    ExpectMovedTo(fine->cameras[i], static_cast<double>(i) / 24);
  }
  EXPECT_EQ(ResamplePath(path, 7, std::nullopt)->frame_count(), 8u);
  EXPECT_EQ(ResamplePath(path, 0.9, std::nullopt)->frame_count(), 1u);
}

TEST(ResamplePath, FramesAreSpreadFromTheFirstToTheLastCamera) {
  const CameraPath path = MovingPath();
  const Result<CameraPath> few = ResamplePath(path, std::nullopt, 4);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->fps, 10);
  ASSERT_EQ(few->frame_count(), 4u);
  for (size_t i = 0; i < 4; ++i) ExpectMovedTo(few->cameras[i], static_cast<double>(i) / 3);
  EXPECT_EQ(few->cameras[1].time_s, 0.1);
  const Result<CameraPath> one = ResamplePath(path, 5, 1);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->fps, 5);
  ExpectMovedTo(one->cameras[0], 0);
}

TEST(ResamplePath, FramesAtOldTimesAreTheOldOnes) {
  const CameraPath path = MovingPath();
  for (const auto& same : {ResamplePath(path, 10, std::nullopt), ResamplePath(path, 20, 21)}) {
    ASSERT_TRUE(same);
    const size_t step = (same->frame_count() - 1) / 10;
    for (size_t i = 0; i < 11; ++i) {
      const RenderCamera &a = path.cameras[i], &b = same->cameras[step * i];
      EXPECT_EQ(a.pinhole.cam_from_world.rotation, b.pinhole.cam_from_world.rotation);
      EXPECT_EQ(a.pinhole.cam_from_world.translation, b.pinhole.cam_from_world.translation);
      EXPECT_EQ(a.focus_plane.offset_w, b.focus_plane.offset_w);
    }
  }
}

TEST(ResamplePath, TheShutterIsKeptAndItsInstantsLieBetweenTheFrames) {
  CameraPath path = MovingPath();
  ASSERT_TRUE(AddShutter({180, 4}, &path));
  EXPECT_EQ(path.instants.size(), 4 * path.frame_count());
  const auto at = [](const RenderCamera& camera) { return camera.pinhole.CentreWorld(); };
  // Instants before the first frame and after the last one have its camera.
  EXPECT_EQ(at(path.Instants(FrameId{1})[0]), at(path.cameras.front()));
  EXPECT_NE(at(path.Instants(FrameId{1})[3]), at(path.cameras.front()));
  EXPECT_EQ(path.instants.back().focus_distance_w, path.cameras.back().focus_distance_w);
  EXPECT_NEAR(path.Instants(FrameId{2})[1].time_s, (1 - 0.0625) / path.fps, 1e-12);
  const Result<CameraPath> slow = ResamplePath(path, 2 * path.fps, std::nullopt);
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->shutter.samples, 4);
  EXPECT_EQ(slow->instants.size(), 4 * slow->frame_count());
  path.cameras.resize(20'000, path.cameras.front());
  EXPECT_EQ(AddShutter({180, kMostShutterSamples}, &path).error().kind, ErrorKind::kUsage);
}

// Expects the path of views to be MovingPath() at these times, each camera moved aside by its
// offset.
void ExpectViewsMovedTo(const CameraPath& views, std::initializer_list<double> offsets_w,
                        double distance_s) {
  ASSERT_EQ(views.views, static_cast<int>(offsets_w.size()));
  for (size_t i = 0; i < views.frame_count(); ++i) {
    const double time_s = static_cast<double>(i / offsets_w.size()) * distance_s;
    const double offset_w = *(offsets_w.begin() + i % offsets_w.size());
    const RenderCamera& camera = views.cameras[i];
    const double yaw_rad = RadiansFromDegrees(20 * time_s);
    const Vec3 right(std::cos(yaw_rad), 0, -std::sin(yaw_rad));
    const Vec3 centre = Vec3(time_s, 0, -2) + offset_w * right;
    // Between two moments, an eye goes straight on, and does not turn about the other.
    EXPECT_LT((camera.pinhole.CentreWorld() - centre).norm(), 1e-6) << i;
    EXPECT_EQ(camera.time_s, static_cast<double>(i) / views.fps);
  }
}

TEST(ResamplePath, EveryViewIsInterpolatedWithItselfAtTheNextMoment) {
  const auto stereo = StereoPath(MovingPath(), 0.02, std::nullopt);
  ASSERT_TRUE(stereo);
  const auto twice = ResamplePath(*stereo, std::nullopt, 42);
  ASSERT_TRUE(twice) << twice.error().message;
  EXPECT_EQ(twice->frame_count(), 42u);
  EXPECT_EQ(twice->fps, 10);
  ExpectViewsMovedTo(*twice, {-0.01, 0.01}, 0.05);
  const auto fine = ResamplePath(*stereo, 20, std::nullopt);  // also 21 moments
  ASSERT_TRUE(fine);
  EXPECT_EQ(fine->frame_count(), 42u);
  ExpectViewsMovedTo(*fine, {-0.01, 0.01}, 0.05);
  const auto one = ResamplePath(*stereo, std::nullopt, 2);
  ASSERT_TRUE(one);
  ExpectViewsMovedTo(*one, {-0.01, 0.01}, 0);
}

TEST(ResamplePath, PartsOfMomentsAndAShutterOfViewsAreRefused) {
  auto stereo = StereoPath(MovingPath(), 0.02, std::nullopt);
  ASSERT_TRUE(stereo);
  const auto odd = ResamplePath(*stereo, std::nullopt, 7);
  ASSERT_FALSE(odd);
  EXPECT_EQ(odd.error().kind, ErrorKind::kUsage);
  EXPECT_NE(odd.error().message.find("multiple of 2"), std::string::npos) << odd.error().message;
  EXPECT_EQ(AddShutter({180, 4}, &*stereo).error().kind, ErrorKind::kUsage);
}

TEST(ResamplePath, TooManyFramesAreRefused) {
  const Result<CameraPath> many = ResamplePath(MovingPath(), 2e6, std::nullopt);
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace lf
