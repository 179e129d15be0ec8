// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/virtual_cameras.h"

#include <algorithm>
#include <cmath>

#include "lf/densify/working_image.h"

namespace lf {
namespace {

constexpr size_t kSources = 6;
constexpr double kExtraWeight = 0.06;  // weight of a source that is no natural neighbour
constexpr double kLeastWeight = 0.03;

Intrinsics MeanIntrinsics(std::span<const PinholeCamera> cameras, std::span<const double> weights) {
  Intrinsics mean = cameras[0].intrinsics;
  mean.fx_px = mean.fy_px = mean.cx_px = mean.cy_px = mean.skew_px = 0;
  for (size_t i = 0; i < cameras.size(); ++i) {
    const Intrinsics& k = cameras[i].intrinsics;
    mean.fx_px += weights[i] * k.fx_px;
    mean.fy_px += weights[i] * k.fy_px;
    mean.cx_px += weights[i] * k.cx_px;
    mean.cy_px += weights[i] * k.cy_px;
    mean.skew_px += weights[i] * k.skew_px;
  }
  return mean;
}

}  // namespace

void AddNearest(std::span<const Vec2> points, const Vec2& place,
                std::vector<WeightedPoint>* sources) {
  if (sources->size() > kSources) sources->resize(kSources);
  while (sources->size() < std::min(kSources, points.size())) {
    uint32_t nearest = UINT32_MAX;
    double distance = INFINITY;
    for (uint32_t i = 0; i < points.size(); ++i) {
      const bool is_taken = std::any_of(sources->begin(), sources->end(),
                                        [&](const WeightedPoint& s) { return s.index == i; });
      if (is_taken || (points[i] - place).norm() >= distance) continue;
      nearest = i;
      distance = (points[i] - place).norm();
    }
    if (nearest == UINT32_MAX) break;
    sources->push_back({nearest, kExtraWeight});
  }
  double sum = 0;
  for (WeightedPoint& source : *sources)
    sum += source.weight = std::max(source.weight, kLeastWeight);
  for (WeightedPoint& source : *sources) source.weight /= sum;
}

VirtualCamera VirtualCameraAt(const LightField& light_field, const CameraPlane& plane,
                              const LatticePlace& at, int divisor) {
  VirtualCamera result;
  std::vector<PinholeCamera> cameras;
  std::vector<Mat3> rotations;
  std::vector<double> weights;
  Vec3 centre = Vec3::Zero();
  for (const WeightedPoint& neighbour : at.neighbours) {
    cameras.push_back(WorkingCamera(light_field.Camera(LfImageId{neighbour.index}), divisor));
    rotations.push_back(cameras.back().cam_from_world.rotation);
    weights.push_back(neighbour.weight);
    centre += neighbour.weight * cameras.back().CentreWorld();
  }
  // 0 inside the hull of the LF cameras, and always if these are on a sphere.
  const Vec2 beyond = at.place - at.inside;
  centre += plane.mean_cam_from_world.rotation.transpose() * Vec3(beyond.x(), beyond.y(), 0);
  result.camera.intrinsics = MeanIntrinsics(cameras, weights);
  result.camera.cam_from_world.rotation = MeanRotation(rotations, weights);
  result.camera.cam_from_world.translation = -(result.camera.cam_from_world.rotation * centre);
  result.sources = at.neighbours;
  AddNearest(plane.points, at.place, &result.sources);
  return result;
}

}  // namespace lf
