// Boxes around the ideal positions of the pixels of a distorted LF image, so that selection can
// tell from afar which part of it may contribute.
#pragma once

#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"

namespace lf {

// A part of the LF image. The ideal position q of each of its pixels that has a ray satisfies
// |q - middle| <= extent in every coordinate, if has_bounds; else nothing is known of it.
struct IdealCell {
  PixelRect rect;
  Vec3 middle;
  Vec3 extent;
  bool has_bounds = false;
};

// The image in about 24 cells along its longer side, each bounded by nine positions, with twice
// the second differences of these added: eight times and more what a smooth lens bends between
// them.
std::vector<IdealCell> MakeIdealCells(const Intrinsics& k);

}  // namespace lf
