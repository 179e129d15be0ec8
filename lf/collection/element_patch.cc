// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/element_patch.h"

#include <array>
#include <cmath>

#include "lf/core/quintic.h"

namespace lf {

std::optional<ElementPatch> ElementPatch::Fit(const PixelForm& x, const PixelForm& y,
                                              const PixelForm& denominator, const IdealPatch& patch,
                                              int x_begin, int x_end) {
  ElementPatch fit;
  fit.x_begin_ = x_begin;
  fit.x_end_ = x_end;
  fit.middle_x_ = 0.5 * (x_begin + x_end);
  fit.middle_y_ = 0.5 * (patch.rect.y_begin + patch.rect.y_end);
  const double half_x = 0.5 * (x_end - x_begin), half_y = 0.5 * patch.rect.height();
  const double width = patch.rect.width();
  // In position() and arc_at(), t and s run from -1 to 1.
  const auto position = [&](const IdealArc& arc, double t) -> Vec2 {
    const Vec3 p = arc.At((fit.middle_x_ + half_x * t - patch.rect.x_begin) / width);
    const double inverse = 1 / Value(denominator, p);
    return {Value(x, p) * inverse, Value(y, p) * inverse};
  };
  const auto arc_at = [&](double s) { return patch.ArcAt(0.5 * (1 + s)); };

  using Points = std::array<Vec2, kTerms>;
  Points along_rows[kTerms];  // [row][power of t]
  for (size_t j = 0; j < kTerms; ++j) {
    const IdealArc arc = arc_at(kQuinticPlaces[j]);
    Points through;
    for (size_t i = 0; i < kTerms; ++i) through[i] = position(arc, kQuinticPlaces[i]);
    along_rows[j] = QuinticThrough(through);
  }
  double scale_x = 1;
  for (size_t k = 0; k < kTerms; ++k) {
    Points through;
    for (size_t j = 0; j < kTerms; ++j) through[j] = along_rows[j][k];
    const Points powers = QuinticThrough(through);
    double scale = scale_x;
    for (size_t l = 0; l < kTerms; ++l) {
      fit.x_[k][l] = powers[l].x() * scale;
      fit.y_[k][l] = powers[l].y() * scale;
      scale /= half_y;
    }
    scale_x /= half_x;
  }

  for (const double s : kQuinticWorstPlaces) {
    const Polynomials along = fit.AlongRow(half_y * s);
    if (!IsNearMiddle(along, half_x)) return std::nullopt;
    const IdealArc arc = arc_at(s);
    for (const double t : kQuinticWorstPlaces) {
      const Vec2 found(QuinticAt(along.x, half_x * t), QuinticAt(along.y, half_x * t));
      // Written so that NaN is rejected.
      if (!((found - position(arc, t)).norm() <= SegmentMaker::kTolerance)) return std::nullopt;
    }
  }
  return fit;
}

Polynomials ElementPatch::AlongRow(double s) const {
  Polynomials along;
  for (int k = 0; k < kTerms; ++k) {
    along.x[k] = QuinticAt(x_[k], s);
    along.y[k] = QuinticAt(y_[k], s);
  }
  return along;
}

void ElementPatch::Append(int y, int x_begin, int x_end, std::vector<Segment>* segments) const {
  constexpr bool kHasParabolas = false;  // the estimator *nearest* does not use them
  AppendSegment(y, x_begin, x_end, middle_x_, AlongRow(y + 0.5 - middle_y_), kHasParabolas,
                segments);
}

}  // namespace lf
