// SPDX-License-Identifier: Apache-2.0
#include "lf/view/overlap_outline.h"

#include <algorithm>
#include <array>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"
#include "lf/camera/ray_forms.h"

namespace lf {
namespace {

constexpr int kBorderSteps = 32;  // steps per side of the LF image at which its border is sampled
constexpr int kEdgeSteps = 12;    // number of straight pieces that approximate a bent edge

using Polygon = std::vector<Vec2>;

// Clips a convex polygon at a line: returns the part where the linear form is at most 0
// (Sutherland, Hodgman 1974).
Polygon Clip(const Polygon& polygon, const PixelForm& form) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = Value(form, a.x(), a.y()), at_b = Value(form, b.x(), b.y());
    if (at_a <= 0) kept.push_back(a);
    if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
      kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return kept;
}

Polygon Box(const Vec2& low, const Vec2& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

// Returns a box around the ideal positions of the LF image's border; nullopt if a border pixel has
// no ray, or a ray that does not point forward.
std::optional<Polygon> IdealBox(const Intrinsics& k, const DistortionMap& map) {
  if (!k.has_distortion()) return Box({0, 0}, {k.width_px, k.height_px});
  Vec2 low = Vec2::Constant(INFINITY), high = Vec2::Constant(-INFINITY);
  for (int i = 0; i <= kBorderSteps; ++i) {
    const double x = k.width_px * static_cast<double>(i) / kBorderSteps;
    const double y = k.height_px * static_cast<double>(i) / kBorderSteps;
    for (const Vec2& p : {Vec2(x, 0), Vec2(x, k.height_px), Vec2(0, y), Vec2(k.width_px, y)}) {
      const std::optional<Vec3> ideal = IdealPosition(k, map, p.x(), p.y());
      if (!ideal || !(ideal->z() > 0)) return std::nullopt;
      low = low.cwiseMin(ideal->head<2>() / ideal->z());
      high = high.cwiseMax(ideal->head<2>() / ideal->z());
    }
  }
  return Box(low, high);
}

// Returns how the LF camera records a polygon that is given in ideal positions: lens distortion
// bends the edges.
Polygon Bent(const Polygon& ideal, const Intrinsics& k, const DistortionMap& map) {
  Polygon bent;
  const Mat3 inverse = k.InverseMatrix();
  for (size_t i = 0; i < ideal.size(); ++i) {
    const Vec2 &a = ideal[i], &b = ideal[(i + 1) % ideal.size()];
    for (int step = 0; step < kEdgeSteps; ++step) {
      const Vec2 q = a + (b - a) * (static_cast<double>(step) / kEdgeSteps);
      const std::optional<Vec2> d = map.Distort(inverse * Vec3(q.x(), q.y(), 1));
      if (!d) continue;
      bent.push_back(
          {std::clamp(k.fx_px * d->x() + k.skew_px * d->y() + k.cx_px, 0.0,
                      static_cast<double>(k.width_px)),
           std::clamp(k.fy_px * d->y() + k.cy_px, 0.0, static_cast<double>(k.height_px))});
    }
  }
  return bent;
}

}  // namespace

std::vector<std::vector<Vec2>> OverlapOutlines(const PinholeCamera& lf_camera,
                                               const RenderCamera& render_camera) {
  const Intrinsics& k = lf_camera.intrinsics;
  const DistortionMap map(k.distortion);
  const std::optional<Polygon> box = IdealBox(k, map);
  if (!box) return {};
  const RayForms forms = MakeRayForms(lf_camera, render_camera);
  const std::vector<PixelForm> lens = LensHalfPlanes(forms, render_camera, 0);
  std::vector<Polygon> outlines;
  for (const int plane_sign : {-1, 1}) {
    Polygon outline = *box;
    for (const PixelForm& form : PlateHalfPlanes(forms, render_camera, plane_sign, 0))
      outline = Clip(outline, form);
    for (const PixelForm& form : lens) outline = Clip(outline, form);
    if (k.has_distortion()) outline = Bent(outline, k, map);
    if (outline.size() >= 3) outlines.push_back(std::move(outline));
  }
  return outlines;
}

}  // namespace lf
