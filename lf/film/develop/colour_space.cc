// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/colour_space.h"

#include <Eigen/LU>

#include "lf/core/check.h"
#include "lf/core/value_named.h"

namespace lf {
namespace {

// Returns the CIE XYZ of a chromaticity at luminance 1.
Vec3 XyzOf(const Vec2& xy) { return {xy.x() / xy.y(), 1, (1 - xy.x() - xy.y()) / xy.y()}; }

// Returns the matrix from linear RGB to CIE XYZ, in which RGB (1, 1, 1) is white at luminance 1.
Mat3 XyzFromRgb(const Primaries& space) {
  Mat3 columns;
  columns << XyzOf(space.red), XyzOf(space.green), XyzOf(space.blue);
  const Vec3 luminances = columns.inverse() * XyzOf(space.white);
  return columns * luminances.asDiagonal();
}

Mat3 BradfordMatrix() {
  Mat3 cones;
  cones << 0.8951, 0.2664, -0.1614,  //
      -0.7502, 1.7135, 0.0367,       //
      0.0389, -0.0685, 1.0296;
  return cones;
}

}  // namespace

std::optional<ColourSpace> ParseColourSpace(std::string_view name) {
  return ValueNamed(name, {ColourSpace::kRec709, ColourSpace::kRec2020, ColourSpace::kAcesCg});
}

const char* NameOf(ColourSpace space) {
  constexpr const char* kNames[] = {"rec709", "rec2020", "acescg"};
  return kNames[static_cast<int>(space)];
}

Primaries PrimariesOf(ColourSpace space) {
  const Vec2 d65(0.3127, 0.3290);
  switch (space) {
    case ColourSpace::kRec709:
      break;
    case ColourSpace::kRec2020:
      return {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65};
    case ColourSpace::kAcesCg:
      return {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
  }
  return {{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, d65};
}

Mat3 LinearFromLinear(const Primaries& to, const Primaries& from) {
  const Mat3 bradford = BradfordMatrix();
  const Vec3 from_white = bradford * XyzOf(from.white), to_white = bradford * XyzOf(to.white);
  const Mat3 adapted =
      bradford.inverse() * to_white.cwiseQuotient(from_white).asDiagonal() * bradford;
  return XyzFromRgb(to).inverse() * adapted * XyzFromRgb(from);
}

void Multiply(const Mat3& matrix, Image<float>* rgb) {
  LF_CHECK(rgb->channels() >= 3);
  for (int y = 0; y < rgb->height(); ++y)
    for (int x = 0; x < rgb->width(); ++x) {
      const Vec3 before(rgb->at(x, y, 0), rgb->at(x, y, 1), rgb->at(x, y, 2));
      const Vec3 after = matrix * before;
      for (int c = 0; c < 3; ++c) rgb->at(x, y, c) = static_cast<float>(after[c]);
    }
}

void ConvertFromRec709(ColourSpace to, Image<float>* rgb) {
  if (to == ColourSpace::kRec709) return;
  Multiply(LinearFromLinear(PrimariesOf(to), PrimariesOf(ColourSpace::kRec709)), rgb);
}

void ConvertToRec709(ColourSpace from, Image<float>* rgb) {
  if (from == ColourSpace::kRec709) return;
  Multiply(LinearFromLinear(PrimariesOf(ColourSpace::kRec709), PrimariesOf(from)), rgb);
}

}  // namespace lf
