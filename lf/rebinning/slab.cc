// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/slab.h"

#include <cmath>

namespace lf {
namespace {

// Returns the parameters along the ray where it cuts the two planes; none if the ray is parallel to
// a plane or does not cut the st plane first.
std::optional<std::array<double, 2>> Parameters(const std::array<double, 2>& distances,
                                                const std::array<double, 2>& slopes) {
  if (slopes[0] == 0 || slopes[1] == 0) return {};
  const std::array<double, 2> along = {distances[0] / slopes[0], distances[1] / slopes[1]};
  if (!(along[0] < along[1])) return {};
  return along;
}

}  // namespace

std::optional<SlabPoint> Parameterize(const Slab& slab, const Ray& ray) {
  const Vec3 normals[2] = {slab.st.Normal(), slab.uv.Normal()};
  const auto along = Parameters({normals[0].dot(slab.st.origin_world - ray.origin),
                                 normals[1].dot(slab.uv.origin_world - ray.origin)},
                                {normals[0].dot(ray.direction), normals[1].dot(ray.direction)});
  if (!along) return {};
  const Vec3 st = ray.At((*along)[0]) - slab.st.origin_world;
  const Vec3 uv = ray.At((*along)[1]) - slab.uv.origin_world;
  return SlabPoint(slab.st.axis_a.dot(st), slab.st.axis_b.dot(st), slab.uv.axis_a.dot(uv),
                   slab.uv.axis_b.dot(uv));
}

Ray RayOfPoint(const Slab& slab, const SlabPoint& point) {
  const Vec3 from = slab.st.origin_world + point[0] * slab.st.axis_a + point[1] * slab.st.axis_b;
  const Vec3 to = slab.uv.origin_world + point[2] * slab.uv.axis_a + point[3] * slab.uv.axis_b;
  return {from, to - from};
}

std::optional<CellKey> KeyOf(const SlabPoint& cells) {
  CellKey key = 0;
  for (int k = 0; k < kCellAxes; ++k) {
    if (!(cells[k] >= -kMostCells && cells[k] < kMostCells)) return {};
    // The sum is above 0, where truncation is floor().
    key |= static_cast<CellKey>(static_cast<int64_t>(cells[k] + kCellOffset)) << (16 * k);
  }
  return key;
}

std::optional<CellKey> CellOf(const Slab& slab, const SlabPoint& point) {
  return KeyOf(SlabPoint(point[0] / slab.r_st_w, point[1] / slab.r_st_w, point[2] / slab.r_uv_w,
                         point[3] / slab.r_uv_w));
}

SlabPoint MiddleOf(const Slab& slab, CellKey key) {
  SlabPoint point;
  for (int k = 0; k < kCellAxes; ++k) {
    const auto number = static_cast<double>((key >> (16 * k)) & 0xffff) - kCellOffset;
    point[k] = (number + 0.5) * (k < 2 ? slab.r_st_w : slab.r_uv_w);
  }
  return point;
}

SlabForms MakeSlabForms(const Slab& slab, const PinholeCamera& lf_camera) {
  const Mat3 direction =
      lf_camera.cam_from_world.rotation.transpose() * lf_camera.intrinsics.InverseMatrix();
  const Vec3 centre = lf_camera.CentreWorld();
  SlabForms forms;
  for (int plane = 0; plane < 2; ++plane) {
    const SlabPlane& here = plane == 0 ? slab.st : slab.uv;
    const Vec3 normal = here.Normal(), offset = centre - here.origin_world;
    forms.distances[plane] = -normal.dot(offset);
    forms.denominators[plane] = normal.transpose() * direction;
    // A ray of direction d cuts the plane with normal n at the point X:
    // (X - origin) n.d = [ offset n^T - (n.offset) I ] d
    const Mat3 meet = offset * normal.transpose() - normal.dot(offset) * Mat3::Identity();
    forms.numerators[2 * plane] = here.axis_a.transpose() * meet * direction;
    forms.numerators[2 * plane + 1] = here.axis_b.transpose() * meet * direction;
  }
  return forms;
}

SlabForms MakeCellForms(const Slab& slab, const PinholeCamera& lf_camera) {
  SlabForms forms = MakeSlabForms(slab, lf_camera);
  for (int k = 0; k < kCellAxes; ++k) forms.numerators[k] /= k < 2 ? slab.r_st_w : slab.r_uv_w;
  return forms;
}

std::optional<SlabPoint> Parameterize(const SlabForms& forms, const Vec3& position) {
  const double per_st = 1 / Value(forms.denominators[0], position);
  const double per_uv = 1 / Value(forms.denominators[1], position);
  // If the ray is parallel to a plane, a divisor above is 0: none is returned here, or the point is
  // not finite.
  if (!(forms.distances[0] * per_st < forms.distances[1] * per_uv)) return {};
  return SlabPoint(
      Value(forms.numerators[0], position) * per_st, Value(forms.numerators[1], position) * per_st,
      Value(forms.numerators[2], position) * per_uv, Value(forms.numerators[3], position) * per_uv);
}

}  // namespace lf
