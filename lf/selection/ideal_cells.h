// SPDX-License-Identifier: Apache-2.0
// Boxes around the ideal positions (without lens distortion) of the pixels of an LF image. With
// them, selection finds quickly which parts of the LF image may contribute.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

// A part of the LF image. If has_bounds, the ideal position q (homogeneous, without lens
// distortion) of each of its pixels that has a ray satisfies |q - middle| <= extent in every
// coordinate. Otherwise q is unknown.
struct IdealCell {
  PixelRect rect;
  Vec3 middle;
  Vec3 extent;
  bool has_bounds = false;
};

// Divides the LF image into cells, at most 24 along its longer side. The box of a cell contains the
// ideal positions of nine points of the cell (its corners, the middles of its sides, its middle),
// and a margin of twice the largest second difference between these. has_bounds is false if one of
// these nine points has no ideal position. The ideal positions of other points of the cell are
// outside of the box of the nine, if the lens is smooth, by at most an eighth of the margin.
std::vector<IdealCell> MakeIdealCells(const Intrinsics& k);

}  // namespace lf
