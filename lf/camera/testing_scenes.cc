// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/testing_scenes.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "lf/core/random.h"

namespace lf::testing {
namespace {

Vec3 Vector(RandomSequence* random, double reach) {
  const double x = random->Uniform(-reach, reach), y = random->Uniform(-reach, reach);
  return {x, y, random->Uniform(-reach, reach)};
}

// Returns the pose of a camera that looks along `forward` and is rolled about its optical axis, so
// that scanlines run in any direction over the plate.
RigidTransform Pose(const Vec3& centre, const Vec3& forward, double roll_rad) {
  RigidTransform pose = *LookAlong(centre, forward, {0.01, -1, 0.02});
  const RigidTransform roll{Eigen::AngleAxisd(roll_rad, Vec3::UnitZ()).toRotationMatrix(),
                            Vec3::Zero()};
  return roll * pose;
}

}  // namespace

CameraPair RandomCameraPair(uint64_t seed) {
  RandomSequence random(seed);
  CameraPair pair;
  RenderCamera& render = pair.render_camera;
  render.pinhole.intrinsics = {300, 310, 80, 60, 0, 160, 120};
  render.pinhole.cam_from_world =
      Pose(Vector(&random, 0.1), Vec3(0, 0, 1) + Vector(&random, 0.2), random.Uniform(-0.3, 0.3));
  constexpr int kBlades[] = {0, 5, 0, 3, 0, 8};
  render.aperture = {random.Uniform(0.05, 0.6), kBlades[seed % 6], random.Uniform(-1, 1)};
  // Every seventh opening is squeezed, and the blades of every seventh are rounded.
  if (seed % 7 == 2) render.aperture.ratio = seed % 2 == 0 ? 1.9 : 0.4;
  if (seed % 7 == 4) render.aperture.roundness = 0.6;
  // Every ninth lens has a hood.
  if (seed % 9 == 5) render.hood = {0.1 * static_cast<double>(seed % 4), 0.3};
  const bool tilted = seed % 4 >= 2;
  const double reach = tilted ? 1.45 : 0;
  render.focus_distance_w = random.Uniform(0.5, 3);
  render.focus_tilt = {random.Uniform(-reach, reach), random.Uniform(-reach, reach)};
  render.focus_plane = FocusPlane(render.pinhole, render.focus_distance_w, render.focus_tilt);

  pair.lf_camera.intrinsics = {60, 62, 25.3, 17.1, 0.5, 50, 35};
  const double turn = seed % 3 == 0 ? 3 : 0.1;
  Vec3 centre = Vector(&random, seed % 11 ? 0.35 : 3);
  if (seed % 5 == 0) {  // moves the LF camera into the lens plane
    const Vec3 f = render.pinhole.ForwardWorld();
    centre -= f * f.dot(centre - render.pinhole.CentreWorld());
  }
  pair.lf_camera.cam_from_world = Pose(
      centre, Vec3(0, 0, 1) + Vector(&random, seed % 7 ? 0.3 : 1.5), random.Uniform(-turn, turn));
  return pair;
}

CameraPair RandomDistortedPair(uint64_t seed) {
  using enum DistortionModel;
  static const Distortion kDistortions[] = {
      {kRadialTangential, {0.035}},
      {kRadialTangential, {-0.25, 0.07, 0.002, -0.003}},
      {kRadialTangential, {0.3, -0.1, 5e-4, -2e-4, 0.02, 0.6, -0.05, 0.01}},
      {kRadialTangential, {-1.2}},
      {kFisheye, {-0.02, 0.004, -0.002, 3e-4}},
      {kFov, {0.93}},
      {kFisheye, {}},
  };
  CameraPair pair = RandomCameraPair(seed);
  Intrinsics& k = pair.lf_camera.intrinsics;
  k = {240, 248, 101.2, 68.4, 0.5, 200, 140, kDistortions[seed % 7]};
  if (seed % 7 == 6) k.fx_px = k.fy_px = 55;  // the fish-eye then sees beyond 90 degrees
  return pair;
}

CameraPair ParallelPair(int column, int row, double pitch_w, double radius_w) {
  CameraPair pair;
  RenderCamera& render = pair.render_camera;
  render.pinhole.intrinsics = {100, 100, 25, 17.5, 0, 50, 35};
  render.aperture = {radius_w, 0, 0};
  render.focus_distance_w = 2;
  render.focus_plane = {Vec3::UnitZ(), 2};
  pair.lf_camera.intrinsics = render.pinhole.intrinsics;
  pair.lf_camera.cam_from_world.translation = {-column * pitch_w, -row * pitch_w, 0};
  return pair;
}

bool SetRandomSurface(int side, double relief, uint64_t seed, RenderCamera* camera) {
  const PinholeCamera& lens = camera->pinhole;
  const Plane& plane = camera->focus_plane;
  const int width = lens.intrinsics.width_px, height = lens.intrinsics.height_px;
  const double distance_w = plane.offset_w - plane.normal.dot(lens.CentreWorld());
  const Vec3 inverse_depth = (plane.normal.transpose() * lens.cam_from_world.rotation.transpose() *
                              lens.intrinsics.InverseMatrix() / distance_w)
                                 .transpose();
  std::vector<FocalPiece> pieces;
  RandomSequence random(seed);
  for (int y = 0; y < height; y += side)
    for (int x = 0; x < width; x += side) {
      const double factor = 1 + relief * random.Uniform(-1, 1);
      pieces.push_back({{x, y, std::min(width, x + side), std::min(height, y + side)},
                        relief == 0 ? inverse_depth : Vec3(inverse_depth * factor)});
    }
  const Result<FocalSurface> surface = FocalSurface::Of(width, height, std::move(pieces));
  if (!surface) return false;
  for (const FocalBlock& block : surface->blocks())
    if (block.q_low * 100 < 1 / camera->focus_distance_w) return false;
  camera->surface = std::make_shared<const FocalSurface>(*surface);
  return true;
}

}  // namespace lf::testing
