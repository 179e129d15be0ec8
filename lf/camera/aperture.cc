#include "lf/camera/aperture.h"

#include <cmath>

#include "lf/core/check.h"
#include "lf/core/random.h"

namespace lf {
namespace {

Vec2 Direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

double VertexAngle(const Aperture& aperture, int index) {
  return kPi / 2 + aperture.rotation_rad + index * 2 * kPi / aperture.blades;
}

}  // namespace

bool Contains(const Aperture& aperture, const Vec2& point_lens) {
  return ApertureTest(aperture).Contains(point_lens);
}

ApertureTest::ApertureTest(const Aperture& aperture)
    : radius2_w2_(aperture.radius_w * aperture.radius_w * (1 + kRimTolerance)) {
  if (aperture.blades > 0) edges_ = Edges(aperture);
}

bool ApertureTest::Contains(const Vec2& point_lens) const {
  if (edges_.empty()) return point_lens.squaredNorm() <= radius2_w2_;
  for (const ApertureEdge& edge : edges_)
    if (edge.normal.dot(point_lens) > edge.distance_w * (1 + kRimTolerance / 2)) return false;
  return true;
}

std::vector<Vec2> Vertices(const Aperture& aperture) {
  std::vector<Vec2> vertices;
  for (int i = 0; i < aperture.blades; ++i)
    vertices.push_back(aperture.radius_w * Direction(VertexAngle(aperture, i)));
  return vertices;
}

std::vector<ApertureEdge> Edges(const Aperture& aperture, int disk_edge_count) {
  LF_CHECK(aperture.blades == 0 || aperture.blades >= 3);
  std::vector<ApertureEdge> edges;
  if (aperture.blades == 0) {
    for (int i = 0; i < disk_edge_count; ++i)
      edges.push_back({Direction(2 * kPi * i / disk_edge_count), aperture.radius_w});
    return edges;
  }
  const double apothem_w = aperture.radius_w * std::cos(kPi / aperture.blades);
  for (int i = 0; i < aperture.blades; ++i)
    edges.push_back({Direction(VertexAngle(aperture, i) + kPi / aperture.blades), apothem_w});
  return edges;
}

double Area(const Aperture& aperture) {
  const double r2 = aperture.radius_w * aperture.radius_w;
  if (aperture.blades == 0) return kPi * r2;
  return 0.5 * aperture.blades * r2 * std::sin(2 * kPi / aperture.blades);
}

std::vector<Vec2> SampleLens(const Aperture& aperture, int count, uint64_t seed) {
  // R2: the additive recurrence of the plastic number, the 2D counterpart of the golden ratio.
  constexpr double kPlastic = 1.32471795724474602596;
  const double step_a = 1 / kPlastic;
  const double step_b = 1 / (kPlastic * kPlastic);
  const double start_a = RandomUnit(seed, 0, 0);
  const double start_b = RandomUnit(seed, 0, 1);
  const std::vector<Vec2> vertices = Vertices(aperture);
  std::vector<Vec2> points;
  points.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    double whole = 0;
    const double a = std::modf(start_a + (i + 0.5) * step_a, &whole);
    const double b = std::modf(start_b + (i + 0.5) * step_b, &whole);
    if (aperture.blades == 0) {
      points.push_back(aperture.radius_w * std::sqrt(a) * Direction(2 * kPi * b));
      continue;
    }
    // The polygon has one triangle (centre, vertex, next vertex) per blade. Points are spread
    // uniformly in each triangle.
    const double scaled = b * aperture.blades;
    const int blade = std::min(static_cast<int>(scaled), aperture.blades - 1);
    const double along = scaled - blade;
    const Vec2 edge_point = (1 - along) * vertices[static_cast<size_t>(blade)] +
                            along * vertices[static_cast<size_t>((blade + 1) % aperture.blades)];
    points.push_back(std::sqrt(a) * edge_point);
  }
  return points;
}

}  // namespace lf
