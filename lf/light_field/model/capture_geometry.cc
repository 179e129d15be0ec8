// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/capture_geometry.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace lf {
namespace {

// Numbers of cameras that are sampled, spread over the light field. Rounding may double them.
constexpr size_t kSpacingSamples = 500;
constexpr size_t kAxisSamples = 20000;
// Cameras nearer together than this share of the distance to the farthest camera have one position:
// tracks that cross, and bursts, repeat positions but for the last digits.
constexpr double kSamePosition = 1e-6;

std::vector<Vec3> Centres(const LightField& light_field) {
  std::vector<Vec3> centres;
  centres.reserve(light_field.size());
  for (const LfCamera& camera : light_field.cameras)
    centres.push_back(camera.cam_from_world.Inverse().translation);
  return centres;
}

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<ptrdiff_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Returns the squared distance of `point` to the line `axis`.
double SquaredDistance(const Vec3& point, const Ray& axis) {
  const Vec3 offset = point - axis.origin;
  return offset.squaredNorm() - std::pow(axis.direction.dot(offset), 2);
}

// Returns the point with the least sum of squared distances to the axes. Returns nullopt if the
// axes are almost parallel: the smallest eigenvalue of the mean of I - d d^T, where d is the
// direction of an axis, is the squared angular spread of the axes.
std::optional<Vec3> NearestPoint(const std::vector<Ray>& axes) {
  constexpr double kLeastSpread = 1e-5;  // squared radians; a spread of about 0.2 degrees
  Mat3 a = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  for (const Ray& axis : axes) {
    const Mat3 across = Mat3::Identity() - axis.direction * axis.direction.transpose();
    a += across / axes.size();
    b += across * axis.origin / axes.size();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(a);
  if (!(eigen.eigenvalues()[0] > kLeastSpread)) return std::nullopt;
  return a.ldlt().solve(b);
}

std::vector<Ray> SampledAxes(const LightField& light_field) {
  std::vector<Ray> axes;
  const size_t step = std::max<size_t>(1, light_field.size() / kAxisSamples);
  for (size_t i = 0; i < light_field.size(); i += step)
    axes.push_back(CentralRay(light_field.Camera(LfImageId{static_cast<uint32_t>(i)})));
  return axes;
}

// Removes the tenth of the axes that is farthest from NearestPoint() of all axes. Returns
// NearestPoint() of the remaining axes, or nullopt if there is no such point.
std::optional<Vec3> NearestWithoutWorst(std::vector<Ray>* axes) {
  const std::optional<Vec3> point = axes->size() < 2 ? std::nullopt : NearestPoint(*axes);
  if (!point) return std::nullopt;
  std::sort(axes->begin(), axes->end(), [&](const Ray& x, const Ray& y) {
    return SquaredDistance(*point, x) < SquaredDistance(*point, y);
  });
  axes->resize(std::max<size_t>(2, axes->size() * 9 / 10));
  return NearestPoint(*axes);
}

}  // namespace

double MedianSpacing(const LightField& light_field) {
  if (light_field.size() < 2) return 0;
  const std::vector<Vec3> centres = Centres(light_field);
  const size_t step = std::max<size_t>(1, centres.size() / kSpacingSamples);
  std::vector<double> nearest;
  for (size_t i = 0; i < centres.size(); i += step) {
    std::vector<double> squares;
    double most = 0;
    for (const Vec3& centre : centres) {
      squares.push_back((centre - centres[i]).squaredNorm());
      most = std::max(most, squares.back());
    }
    double least = most;
    for (const double square : squares)
      if (square > kSamePosition * kSamePosition * most) least = std::min(least, square);
    nearest.push_back(std::sqrt(least));
  }
  return Percentile(std::move(nearest), 0.5);
}

double CopiesApart_px(double fx_px, double spacing_w, double focus_w, double depth_w) {
  return fx_px * spacing_w * std::abs(1 / focus_w - 1 / depth_w);
}

LfImageId MiddleCamera(const LightField& light_field,
                       const std::function<bool(LfImageId)>& is_wanted) {
  LF_CHECK(light_field.size() > 0);
  const std::vector<Vec3> centres = Centres(light_field);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& centre : centres) mean += centre / static_cast<double>(centres.size());
  // The camera nearest to the mean position is at the top of the heap; among equally near cameras,
  // the one with the lowest number.
  std::vector<std::pair<double, uint32_t>> heap;
  for (uint32_t i = 0; i < centres.size(); ++i)
    heap.emplace_back((centres[i] - mean).squaredNorm(), i);
  std::make_heap(heap.begin(), heap.end(), std::greater<>());
  const LfImageId nearest{heap.front().second};
  for (; is_wanted && !heap.empty(); heap.pop_back()) {
    if (is_wanted(LfImageId{heap.front().second})) return {heap.front().second};
    std::pop_heap(heap.begin(), heap.end(), std::greater<>());
  }
  return nearest;
}

Vec3 MeanUpWorld(const LightField& light_field) {
  constexpr double kLeastInCommon = 0.1;
  Vec3 mean = Vec3::Zero();
  for (const LfCamera& camera : light_field.cameras)
    mean -=
        camera.cam_from_world.rotation.row(1).transpose() / static_cast<double>(light_field.size());
  return mean.norm() < kLeastInCommon ? Vec3::Zero() : Vec3(mean.normalized());
}

double RollOf(const PinholeCamera& camera, const Vec3& up_world) {
  constexpr double kLeastAcross = 0.1;
  const Vec2 across(camera.RightWorld().dot(up_world), camera.UpWorld().dot(up_world));
  return across.norm() < kLeastAcross ? 0 : std::abs(std::atan2(across.x(), across.y()));
}

Ray CentralRay(const PinholeCamera& camera) {
  const Intrinsics& k = camera.intrinsics;
  if (k.has_distortion()) return {camera.CentreWorld(), camera.ForwardWorld()};
  const double y = (k.height_px / 2.0 - k.cy_px) / k.fy_px;
  const double x = (k.width_px / 2.0 - k.cx_px - k.skew_px * y) / k.fx_px;
  const Vec3 direction = camera.cam_from_world.rotation.transpose() * Vec3(x, y, 1);
  return {camera.CentreWorld(), direction.normalized()};
}

std::optional<Vec3> PointNearestToAxes(const LightField& light_field) {
  std::vector<Ray> axes = SampledAxes(light_field);
  return NearestWithoutWorst(&axes);
}

std::optional<Vec3> AxesMeetingPoint(const LightField& light_field) {
  std::vector<Ray> axes = SampledAxes(light_field);
  const std::optional<Vec3> point = NearestWithoutWorst(&axes);
  if (!point) return std::nullopt;
  const auto in_front = std::count_if(axes.begin(), axes.end(), [&](const Ray& axis) {
    return axis.direction.dot(*point - axis.origin) > 0;
  });
  if (static_cast<size_t>(in_front) * 10 < axes.size() * 9) return std::nullopt;
  return point;
}

Reach CaptureReach(const LightField& light_field, const PinholeCamera& camera, size_t count) {
  LF_CHECK(light_field.size() > 0 && count > 0);
  std::vector<Vec3> offsets = Centres(light_field);
  for (Vec3& offset : offsets) offset -= camera.CentreWorld();
  count = std::min(count, offsets.size());
  std::nth_element(offsets.begin(), offsets.begin() + static_cast<ptrdiff_t>(count) - 1,
                   offsets.end(),
                   [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
  std::vector<double> right, up;
  for (size_t i = 0; i < count; ++i) {
    right.push_back(std::abs(camera.RightWorld().dot(offsets[i])));
    up.push_back(std::abs(camera.UpWorld().dot(offsets[i])));
  }
  return {Percentile(std::move(right), 0.8), Percentile(std::move(up), 0.8)};
}

}  // namespace lf
