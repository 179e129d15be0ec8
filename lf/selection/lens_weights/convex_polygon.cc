// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/convex_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lf {
namespace {

// Returns the area of the intersection of the triangle (origin, a, b) with the disk around the
// origin; negative if the triangle is clockwise.
double TriangleAreaInDisk(const Vec2& a, const Vec2& b, double radius) {
  const double r2 = radius * radius;
  const auto sector = [r2](const Vec2& from, const Vec2& to) {
    return 0.5 * r2 * std::atan2(Cross(from, to), from.dot(to));
  };
  // Finds the parameters t at which the edge a + t (b - a) crosses the border of the disk.
  const Vec2 edge = b - a;
  const double length2 = edge.squaredNorm();
  if (length2 == 0) return 0;
  const double middle = -a.dot(edge) / length2;
  const double rest = middle * middle - (a.squaredNorm() - r2) / length2;
  if (rest <= 0) return sector(a, b);
  const double half = std::sqrt(rest);
  const double enters = std::max(0.0, middle - half), leaves = std::min(1.0, middle + half);
  if (enters >= leaves) return sector(a, b);
  const Vec2 p = a + enters * edge, q = a + leaves * edge;
  double area = 0.5 * Cross(p, q);
  if (enters > 0) area += sector(a, p);
  if (leaves < 1) area += sector(q, b);
  return area;
}

}  // namespace

ConvexPolygon ConvexPolygon::SquareAround(const Vec2& middle, double half_side) {
  const double h = half_side;
  return ConvexPolygon(
      {middle + Vec2(-h, -h), middle + Vec2(h, -h), middle + Vec2(h, h), middle + Vec2(-h, h)});
}

bool ConvexPolygon::Clip(const Vec2& normal, double offset) {
  // Clip() is called millions of times for a frame, nearly always on less than ten vertices, so
  // that memory on the stack is worthwhile.
  constexpr size_t kFew = 32;
  std::array<double, kFew> past_of_few;
  std::vector<double> past_of_many;
  const size_t count = vertices_.size();
  double* past = past_of_few.data();
  if (count > kFew) {
    past_of_many.resize(count);
    past = past_of_many.data();
  }
  bool is_all = true;
  for (size_t i = 0; i < count; ++i) {
    past[i] = normal.dot(vertices_[i]) - offset;
    is_all &= past[i] <= 0;
  }
  if (is_all) return false;
  kept_.clear();
  for (size_t i = 0; i < count; ++i) {
    const size_t next = i + 1 < count ? i + 1 : 0;
    const Vec2& a = vertices_[i];
    const Vec2& b = vertices_[next];
    if (past[i] <= 0) kept_.push_back(a);
    if ((past[i] < 0 && past[next] > 0) || (past[i] > 0 && past[next] < 0))
      kept_.push_back(a + past[i] / (past[i] - past[next]) * (b - a));
  }
  if (kept_.size() < 3) kept_.clear();
  vertices_.swap(kept_);
  return true;
}

double ConvexPolygon::FarthestFrom(const Vec2& point) const {
  double most = 0;
  for (const Vec2& v : vertices_) most = std::max(most, (v - point).squaredNorm());
  return std::sqrt(most);
}

std::pair<double, double> ConvexPolygon::Extent(const Vec2& normal) const {
  double least = normal.dot(vertices_.front()), most = least;
  for (const Vec2& v : vertices_) {
    least = std::min(least, normal.dot(v));
    most = std::max(most, normal.dot(v));
  }
  return {least, most};
}

double ConvexPolygon::Area() const {
  double twice = 0;
  for (size_t i = 0; i < vertices_.size(); ++i)
    twice += Cross(vertices_[i], vertices_[(i + 1) % vertices_.size()]);
  return 0.5 * twice;
}

double ConvexPolygon::AreaInDisk(double radius) const {
  double area = 0;
  for (size_t i = 0; i < vertices_.size(); ++i)
    area += TriangleAreaInDisk(vertices_[i], vertices_[(i + 1) % vertices_.size()], radius);
  return area;
}

}  // namespace lf
