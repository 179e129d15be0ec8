// Boxes around the ideal positions of the pixels of a distorted LF image, from which selection
// tells quickly which parts of it may contribute.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

// A part of the LF image. If has_bounds, the ideal position q of each of its pixels that has a ray
// satisfies |q - middle| <= extent in every coordinate. Otherwise q is unknown.
struct IdealCell {
  PixelRect rect;
  Vec3 middle;
  Vec3 extent;
  bool has_bounds = false;
};

// Divides the image into about 24 cells along its longer side. The bounds of a cell are those of
// nine positions, plus twice their second differences: at least eight times what a smooth lens
// bends between them.
std::vector<IdealCell> MakeIdealCells(const Intrinsics& k);

}  // namespace lf
