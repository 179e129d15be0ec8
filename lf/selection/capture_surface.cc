// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/capture_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "lf/selection/principal_axes.h"

namespace lf {
namespace {

// Returns finite positions relative to their mean.
std::vector<Vec3> Centred(std::span<const Vec3> positions) {
  std::vector<Vec3> points;
  points.reserve(positions.size());
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0; };
  for (const Vec3& p : positions) points.push_back({finite(p.x()), finite(p.y()), finite(p.z())});
  const Vec3 mean = MeanOf(points);
  for (Vec3& p : points) p = {p.x() - mean.x(), p.y() - mean.y(), p.z() - mean.z()};
  return points;
}

// Returns the centre of the sphere that fits the points, which must be relative to their mean.
// nullopt if they are nearly on a line, or nearer to their plane of least variance.
std::optional<Vec3> CentreOfSphere(const std::vector<Vec3>& points,
                                   const PrincipalAxes& principal) {
  constexpr double kBetter = 0.5;  // largest ratio of the mean distances from sphere and plane
  // The centre is in the middle of the points along an axis on which they extend this little,
  // because a narrow band in a half circle tells nothing of the centre across the band.
  const double least_variance = 0.01 * principal.variances[0];
  if (!(principal.variances[1] > least_variance)) return std::nullopt;
  const auto count = static_cast<double>(points.size());
  // The sum of (|q - c|^2 - r^2)^2 is least where 2 C c = mean of |q|^2 q, with the covariance C.
  Vec3 centre = Vec3::Zero();
  for (size_t k = 0; k < 3; ++k) {
    if (!(principal.variances[k] > least_variance)) continue;
    double moment = 0;
    for (const Vec3& q : points) moment += Dot(q, q) * Dot(q, principal.axes[k]) / count;
    const double along = moment / (2 * principal.variances[k]);
    const Vec3& axis = principal.axes[k];
    centre = {centre.x() + along * axis.x(), centre.y() + along * axis.y(),
              centre.z() + along * axis.z()};
  }
  double mean = 0, square = 0;
  for (const Vec3& q : points) {
    const double radius = Length({q.x() - centre.x(), q.y() - centre.y(), q.z() - centre.z()});
    mean += radius / count;
    square += radius * radius / count;
  }
  const double variance = std::max(0.0, square - mean * mean);
  if (!(variance < kBetter * kBetter * principal.variances[2])) return std::nullopt;
  return centre;
}

// Points as they are seen along two orthogonal axes of the world.
struct Chart {
  Vec3 right, up;
  std::vector<Vec2> points;
};

Chart PlaneChart(const std::vector<Vec3>& points, const PrincipalAxes& principal) {
  Chart chart{principal.axes[0], principal.axes[1], {}};
  chart.points.reserve(points.size());
  for (const Vec3& p : points) chart.points.push_back({Dot(p, chart.right), Dot(p, chart.up)});
  return chart;
}

Chart SphereChart(const std::vector<Vec3>& points, const PrincipalAxes& principal,
                  const Vec3& centre) {
  constexpr double kAllAround = 0.1;  // mean of directions of length 1, if they go everywhere
  constexpr double kOpposite = 1e-9;  // the point opposite to the middle has no direction
  std::vector<Vec3> directions;
  directions.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 offset = {p.x() - centre.x(), p.y() - centre.y(), p.z() - centre.z()};
    directions.push_back(Length(offset) > 0 ? Unit(offset) : principal.axes[2]);
  }
  const Vec3 mean = MeanOf(directions);
  const Vec3 middle = Length(mean) > kAllAround ? Unit(mean) : principal.axes[2];
  size_t across = 0;  // the principal axis that is the farthest from the direction of the middle
  for (size_t k = 1; k < 3; ++k)
    if (std::abs(Dot(principal.axes[k], middle)) < std::abs(Dot(principal.axes[across], middle)))
      across = k;
  Chart chart;
  chart.up = Unit(Cross(middle, principal.axes[across]));
  chart.right = Cross(chart.up, middle);
  chart.points.reserve(points.size());
  for (const Vec3& d : directions) {
    const double along = 1 + Dot(d, middle);
    const double scale = along > kOpposite ? std::sqrt(2 / along) : 0;
    chart.points.push_back(along > kOpposite
                               ? Vec2(scale * Dot(d, chart.right), scale * Dot(d, chart.up))
                               : Vec2(2, 0));
  }
  return chart;
}

// Returns (cos a, sin a) of the angle a, at most 45 degrees, by which the rows or columns of the
// points are turned against the axes; (1, 0) if they have none. A fourth power tells the direction
// from a point to its nearest neighbour, whichever of the four it is.
Vec2 TurnOf(const std::vector<Vec2>& points) {
  constexpr size_t kSamples = 256;
  constexpr double kSamePosition = 1e-6;  // share of the extent of all points
  constexpr double kRegular = 0.5;        // least mean of powers of length 1, if there are rows
  const size_t step = std::max<size_t>(1, points.size() / kSamples);
  const auto square = [](const Vec2& d) { return d.x() * d.x() + d.y() * d.y(); };
  double most = 0;
  for (const Vec2& p : points) most = std::max(most, square(p));
  double re = 0, im = 0, count = 0;
  for (size_t i = 0; i < points.size(); i += step) {
    const auto offset = [&](const Vec2& p) {
      return Vec2(p.x() - points[i].x(), p.y() - points[i].y());
    };
    double least = std::numeric_limits<double>::infinity();
    Vec2 nearest(0, 0);
    for (const Vec2& p : points) {
      const Vec2 d = offset(p);
      const double square_of_d = square(d);
      if (square_of_d >= least || !(square_of_d > kSamePosition * kSamePosition * most)) continue;
      least = square_of_d;
      nearest = d;
    }
    if (!std::isfinite(least)) continue;
    const double x = nearest.x() * nearest.x() - nearest.y() * nearest.y();
    const double y = 2 * nearest.x() * nearest.y();
    re += (x * x - y * y) / (least * least);
    im += 2 * x * y / (least * least);
    ++count;
  }
  const double length = std::sqrt(re * re + im * im);
  if (!(length > kRegular * count)) return {1, 0};
  // Halves the angle twice.
  double cosine = re / length, sine = im / length;
  for (int halving = 0; halving < 2; ++halving) {
    const double half = std::sqrt(std::max(0.0, (1 + cosine) / 2));
    sine = half > 0 ? sine / (2 * half) : 1;
    cosine = half;
  }
  return {cosine, sine};
}

// The axes of a surface, as vectors of a chart and, for the chart of a plane, of the world.
struct RowAxes {
  Vec2 x, y;
  Vec3 x_world, y_world;
};

// Returns the axes along which rows or columns are, and which agree with those of the world as far
// as possible. The order is then the same if LF cameras are listed in another order.
RowAxes RowAxesOf(const Chart& chart) {
  const Vec2 turn = TurnOf(chart.points);
  RowAxes axes{{turn.x(), turn.y()}, {-turn.y(), turn.x()}, {}, {}};
  const auto in_world = [&](const Vec2& axis) {
    Vec3 world;
    for (int k = 0; k < 3; ++k) world[k] = axis.x() * chart.right[k] + axis.y() * chart.up[k];
    return world;
  };
  axes.x_world = in_world(axes.x);
  axes.y_world = in_world(axes.y);
  constexpr double kMargin = 1e-6;
  const auto leads = [&](const Vec3& a, const Vec3& b) {  // a is rather the x axis than b
    for (int k = 0; k < 3; ++k)
      if (std::abs(std::abs(a[k]) - std::abs(b[k])) > kMargin)
        return std::abs(a[k]) > std::abs(b[k]);
    return true;
  };
  const auto make_positive = [&](Vec2* axis, Vec3* world) {
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs((*world)[k]) > kMargin)) continue;
      if ((*world)[k] > 0) return;
      *axis = {-axis->x(), -axis->y()};
      *world = {-world->x(), -world->y(), -world->z()};
      return;
    }
  };
  make_positive(&axes.x, &axes.x_world);
  make_positive(&axes.y, &axes.y_world);
  if (!leads(axes.x_world, axes.y_world)) {
    std::swap(axes.x, axes.y);
    std::swap(axes.x_world, axes.y_world);
  }
  return axes;
}

// Returns the points of the chart along RowAxesOf().
std::vector<Vec2> Turned(Chart chart) {
  const RowAxes axes = RowAxesOf(chart);
  for (Vec2& p : chart.points)
    p = {axes.x.x() * p.x() + axes.x.y() * p.y(), axes.y.x() * p.x() + axes.y.y() * p.y()};
  return std::move(chart.points);
}

}  // namespace

PlaneAxes PlaneAxesOf(std::span<const Vec3> positions) {
  if (positions.empty()) return {};
  const std::vector<Vec3> points = Centred(positions);
  const RowAxes axes = RowAxesOf(PlaneChart(points, AxesOf(points)));
  return {axes.x_world, axes.y_world, Cross(axes.x_world, axes.y_world)};
}

std::vector<SurfacePoint> SurfaceOf(std::span<const Vec3> positions) {
  if (positions.empty()) return {};
  const std::vector<Vec3> points = Centred(positions);
  const PrincipalAxes principal = AxesOf(points);
  const std::optional<Vec3> centre = CentreOfSphere(points, principal);
  const std::vector<Vec2> plane =
      Turned(centre ? SphereChart(points, principal, *centre) : PlaneChart(points, principal));
  Vec2 least = plane[0], most = plane[0];
  for (const Vec2& p : plane)
    for (int k = 0; k < 2; ++k) {
      least[k] = std::min(least[k], p[k]);
      most[k] = std::max(most[k], p[k]);
    }
  const double extent = std::max(most.x() - least.x(), most.y() - least.y());
  std::vector<SurfacePoint> result(positions.size());
  if (!(extent > 0) || !std::isfinite(extent)) return result;
  const auto rounded = [&](double x) {
    return static_cast<int32_t>(std::floor(x / extent * SurfacePoint::kMost + 0.5));
  };
  for (size_t i = 0; i < plane.size(); ++i)
    result[i] = {rounded(plane[i].x() - least.x()), rounded(plane[i].y() - least.y())};
  return result;
}

}  // namespace lf
