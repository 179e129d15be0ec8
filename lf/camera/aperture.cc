// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/aperture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/random.h"

namespace lf {
namespace {

// The largest number of vertices of an opening with curved edges; planners keep a bit for each
// edge.
constexpr int kCurveVertices = 40;

Vec2 Direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

double VertexAngle(const Aperture& aperture, int index) {
  return kPi / 2 + aperture.rotation_rad + index * 2 * kPi / aperture.blades;
}

// Returns the points of a circle of radius 1 whose polygon has the area of the circle.
std::vector<Vec2> RoundVertices() {
  constexpr double kStep = 2 * kPi / kCurveVertices;
  const double radius = std::sqrt(kStep / std::sin(kStep));
  std::vector<Vec2> vertices;
  for (int i = 0; i < kCurveVertices; ++i) vertices.push_back(radius * Direction(i * kStep));
  return vertices;
}

// Appends the points, on a circle of radius 1, of the arc of a blade whose edge begins at the angle
// `from`, without its end.
void AddArc(const Aperture& aperture, double from, std::vector<Vec2>* vertices) {
  const double half = kPi / aperture.blades;
  const double chord = std::sin(half);  // half of it
  const double rise = aperture.roundness * (1 - std::cos(half));
  const double arc_radius = (chord * chord + rise * rise) / (2 * rise);
  const double arc_centre = std::cos(half) + rise - arc_radius;  // on the bisector of the edge
  const double arc_half = std::asin(chord / arc_radius);
  const int steps = std::max(1, kCurveVertices / aperture.blades);
  const Vec2 bisector = Direction(from + half);
  const Vec2 across(-bisector.y(), bisector.x());
  for (int i = 0; i < steps; ++i) {
    const double angle = arc_half * (2.0 * i / steps - 1);
    vertices->push_back((arc_centre + arc_radius * std::cos(angle)) * bisector +
                        arc_radius * std::sin(angle) * across);
  }
}

// Squeezes the points as an anamorphic lens does.
void Squeeze(double ratio, std::vector<Vec2>* points) {
  if (ratio == 1) return;
  const Vec2 scale(std::min(1.0, 1 / ratio), std::min(1.0, ratio));
  for (Vec2& point : *points) point = point.cwiseProduct(scale);
}

// Returns the vertices of a polygon with curved or squeezed edges and the radius 1.
std::vector<Vec2> UnitVertices(const Aperture& aperture) {
  std::vector<Vec2> vertices;
  if (aperture.blades == 0 || aperture.roundness == 1)
    vertices = RoundVertices();
  else
    for (int i = 0; i < aperture.blades; ++i)
      if (aperture.roundness == 0)
        vertices.push_back(Direction(VertexAngle(aperture, i)));
      else
        AddArc(aperture, VertexAngle(aperture, i), &vertices);
  Squeeze(aperture.ratio, &vertices);
  return vertices;
}

double AreaOf(const std::vector<Vec2>& vertices) {
  double twice = 0;
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 &a = vertices[i], &b = vertices[(i + 1) % vertices.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

// Returns the edges between the vertices of a convex polygon, which are counter-clockwise.
std::vector<ApertureEdge> EdgesBetween(const std::vector<Vec2>& vertices) {
  std::vector<ApertureEdge> edges;
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 along = vertices[(i + 1) % vertices.size()] - vertices[i];
    const Vec2 normal = Vec2(along.y(), -along.x()).normalized();
    edges.push_back({normal, normal.dot(vertices[i])});
  }
  return edges;
}

// Maps points of the unit square to a polygon around the lens centre, uniformly.
class PolygonSampler {
 public:
  explicit PolygonSampler(std::vector<Vec2> vertices) : vertices_(std::move(vertices)) {
    double sum = 0;
    for (size_t i = 0; i < vertices_.size(); ++i)
      ends_.push_back(sum += AreaOf({Vec2::Zero(), vertices_[i], Next(i)}));
  }
  Vec2 At(double a, double b) const {
    const double area = b * ends_.back();
    const size_t i = std::min<size_t>(
        std::upper_bound(ends_.begin(), ends_.end(), area) - ends_.begin(), ends_.size() - 1);
    const double begin = i == 0 ? 0 : ends_[i - 1];
    const double along = (area - begin) / (ends_[i] - begin);
    return std::sqrt(a) * ((1 - along) * vertices_[i] + along * Next(i));
  }
  // Does the same if all triangles are equal.
  Vec2 AtEqual(double a, double b) const {
    const double scaled = b * static_cast<double>(vertices_.size());
    const size_t i = std::min(static_cast<size_t>(scaled), vertices_.size() - 1);
    const double along = scaled - static_cast<double>(i);
    return std::sqrt(a) * ((1 - along) * vertices_[i] + along * Next(i));
  }

 private:
  const Vec2& Next(size_t i) const { return vertices_[(i + 1) % vertices_.size()]; }
  std::vector<Vec2> vertices_;
  std::vector<double> ends_;  // sums of the areas of the first triangles
};

}  // namespace

bool Contains(const Aperture& aperture, const Vec2& point_lens) {
  return ApertureTest(aperture).Contains(point_lens);
}

ApertureTest::ApertureTest(const Aperture& aperture)
    : radius2_w2_(aperture.radius_w * aperture.radius_w * (1 + kRimTolerance)) {
  if (!aperture.IsDisk()) edges_ = Edges(aperture);
}

bool ApertureTest::IsWithinEdges(const Vec2& point_lens) const {
  for (const ApertureEdge& edge : edges_)
    if (edge.normal.dot(point_lens) > edge.distance_w * (1 + kRimTolerance / 2)) return false;
  return true;
}

std::vector<Vec2> Vertices(const Aperture& aperture) {
  LF_CHECK(aperture.blades == 0 || aperture.blades >= 3);
  if (aperture.IsDisk()) return {};
  std::vector<Vec2> vertices = UnitVertices(aperture);
  for (Vec2& vertex : vertices) vertex *= aperture.radius_w;
  return vertices;
}

std::vector<Vec2> RimVertices(const Aperture& aperture) {
  if (!aperture.IsDisk()) return Vertices(aperture);
  std::vector<Vec2> vertices = RoundVertices();
  for (Vec2& vertex : vertices) vertex *= aperture.radius_w;
  return vertices;
}

std::vector<ApertureEdge> Edges(const Aperture& aperture, int disk_edge_count) {
  LF_CHECK(aperture.blades == 0 || aperture.blades >= 3);
  std::vector<ApertureEdge> edges;
  if (aperture.IsDisk()) {
    for (int i = 0; i < disk_edge_count; ++i)
      edges.push_back({Direction(2 * kPi * i / disk_edge_count), aperture.radius_w});
    return edges;
  }
  if (!aperture.IsPlainPolygon()) {
    edges = EdgesBetween(UnitVertices(aperture));
    for (ApertureEdge& edge : edges) edge.distance_w *= aperture.radius_w;
    return edges;
  }
  const double apothem_w = aperture.radius_w * std::cos(kPi / aperture.blades);
  for (int i = 0; i < aperture.blades; ++i)
    edges.push_back({Direction(VertexAngle(aperture, i) + kPi / aperture.blades), apothem_w});
  return edges;
}

double Area(const Aperture& aperture) {
  const double r2 = aperture.radius_w * aperture.radius_w;
  if (aperture.IsDisk()) return kPi * r2;
  if (!aperture.IsPlainPolygon()) return AreaOf(Vertices(aperture));
  return 0.5 * aperture.blades * r2 * std::sin(2 * kPi / aperture.blades);
}

std::vector<Vec2> SampleLens(const Aperture& aperture, int count, uint64_t seed) {
  // R2: the additive recurrence of the plastic number, the 2D counterpart of the golden ratio.
  constexpr double kPlastic = 1.32471795724474602596;
  const double step_a = 1 / kPlastic;
  const double step_b = 1 / (kPlastic * kPlastic);
  const double start_a = RandomUnit(seed, 0, 0);
  const double start_b = RandomUnit(seed, 0, 1);
  const bool is_round = aperture.blades == 0 || aperture.roundness == 1;
  const PolygonSampler polygon(is_round ? std::vector<Vec2>() : Vertices(aperture));
  std::vector<Vec2> points;
  points.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    double whole = 0;
    const double a = std::modf(start_a + (i + 0.5) * step_a, &whole);
    const double b = std::modf(start_b + (i + 0.5) * step_b, &whole);
    if (is_round || aperture.radius_w == 0)
      points.push_back(aperture.radius_w * std::sqrt(a) * Direction(2 * kPi * b));
    else
      points.push_back(aperture.IsPlainPolygon() ? polygon.AtEqual(a, b) : polygon.At(a, b));
  }
  if (is_round) Squeeze(aperture.ratio, &points);
  return points;
}

}  // namespace lf
