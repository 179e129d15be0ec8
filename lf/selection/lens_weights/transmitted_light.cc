// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/transmitted_light.h"

#include <algorithm>
#include <cmath>

namespace lf {
namespace {

// A range of rows or columns of the picture.
struct PlaceRows {
  int begin;
  int end;
};

// Returns the rows (or columns) that the polygon touches.
//   normal, middle  a point p is in row floor(normal . p + middle)
PlaceRows TouchedBy(const ConvexPolygon& polygon, const Vec2& normal, double middle, int side) {
  const auto [least, most] = polygon.Extent(normal);
  const auto row = [&](double x) {
    return static_cast<int>(std::clamp(std::floor(x + middle), 0.0, static_cast<double>(side)));
  };
  return {row(least), std::min(row(most) + 1, side)};
}

// Keeps the part of the polygon in one row (or column).
void KeepRow(const Vec2& normal, double middle, int row, ConvexPolygon* polygon) {
  polygon->Clip(normal, row + 1 - middle);
  polygon->Clip(-normal, middle - row);
}

}  // namespace

double TransmittedLight(const Transmission& transmission, const Aperture& aperture,
                        const ConvexPolygon& polygon) {
  if (polygon.empty()) return 0;
  const TransmissionAxes axes(transmission, aperture);
  const int side = transmission.side();
  double light = 0;
  const PlaceRows rows = TouchedBy(polygon, axes.down, axes.middle, side);
  for (int row = rows.begin; row < rows.end; ++row) {
    ConvexPolygon strip = polygon;
    KeepRow(axes.down, axes.middle, row, &strip);
    if (strip.empty()) continue;
    const PlaceRows columns = TouchedBy(strip, axes.across, axes.middle, side);
    for (int column = columns.begin; column < columns.end; ++column) {
      const int share = transmission.Share(column, row);
      if (share == 0) continue;
      ConvexPolygon place = strip;
      KeepRow(axes.across, axes.middle, column, &place);
      light += share / 255.0 * place.Area();
    }
  }
  return light;
}

}  // namespace lf
