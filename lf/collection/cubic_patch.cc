#include "lf/collection/cubic_patch.h"

#include "lf/collection/even_cubic.h"

namespace lf {
namespace {

// values [row][column]
void InterpolateBoth(const double (&values)[4][4], double half_x, double half_y,
                     double (&c)[4][4]) {
  double along[4][4];  // [row][power of t]
  for (int j = 0; j < 4; ++j) InterpolateEven(values[j], half_x, along[j]);
  for (int k = 0; k < 4; ++k)
    InterpolateEven({along[0][k], along[1][k], along[2][k], along[3][k]}, half_y, c[k]);
}

}  // namespace

CubicPatch::CubicPatch(const PixelForm& x, const PixelForm& y, const PixelForm& denominator,
                       const IdealPatch& patch)
    : middle_x_(0.5 * (patch.rect.x_begin + patch.rect.x_end)),
      middle_y_(0.5 * (patch.rect.y_begin + patch.rect.y_end)),
      half_x_(0.5 * patch.rect.width()) {
  double x_values[4][4], y_values[4][4];
  for (int j = 0; j < 4; ++j) {
    const IdealArc arc = patch.ArcAt(j / 3.0);
    for (int i = 0; i < 4; ++i) {
      const Vec3 p = arc.At(i / 3.0);
      const double inverse = 1 / Value(denominator, p);
      x_values[j][i] = Value(x, p) * inverse;
      y_values[j][i] = Value(y, p) * inverse;
    }
  }
  const double half_y = 0.5 * patch.rect.height();
  InterpolateBoth(x_values, half_x_, half_y, x_);
  InterpolateBoth(y_values, half_x_, half_y, y_);
}

bool CubicPatch::IsNearMiddle() const {
  return lf::IsNearMiddle({{0, x_[1][0], 0, 0}, {0, y_[1][0], 0, 0}}, half_x_);
}

void CubicPatch::Append(int y, int x_begin, int x_end, std::vector<CubicSegment>* segments) const {
  const double s = y + 0.5 - middle_y_;
  Cubics cubics;
  for (int k = 0; k < 4; ++k) {
    cubics.x[k] = ((x_[k][3] * s + x_[k][2]) * s + x_[k][1]) * s + x_[k][0];
    cubics.y[k] = ((y_[k][3] * s + y_[k][2]) * s + y_[k][1]) * s + y_[k][0];
  }
  segments->push_back(MakeSegment(y, x_begin, x_end, middle_x_, cubics));
}

}  // namespace lf
