// SPDX-License-Identifier: Apache-2.0
// Finds the missing colours of a tile of an LF image in what its neighbours recorded. Internal to
// this folder.
//
// A pixel p has recorded one colour; D is the LF image demosaicked by itself. A neighbour j shows p
// at a place q, given the inverse depth of p. A pixel of j at q + o has recorded a value R of the
// colour c, from which D differs by R - D_c(p + o). Pixels near q say by how much D_c(p) is wrong:
//
//   D'_c(p) = D_c(p) + sum of w (R - D_c(p + o)) / (sum of w + kPrior)
//   w = agreement(j, p) * nearness(j) * kernel(|o|) / (1 + ((R - D_c(p + o)) / s)^2)
//
// - agreement() compares D of both LF images around p and q, so that what j does not show, because
//   something hides it or because it glitters, has no effect.
// - s is the contrast of D around p, and some noise: a larger difference is an outlier.
// - D' is found three times, with the D' before in place of D, because values of D at p + o have
//   errors like those at p.
// - Recorded values are kept.
//
// This is kernel regression of raw samples (Wronski et al., "Handheld multi-frame
// super-resolution", 2019), of residuals instead of values: without samples, the result is D.
//
// All operations are sums, products, quotients and square roots in a fixed order, so that every
// machine computes the same bits.
#pragma once

#include <span>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/densify/demosaic/joint_image.h"
#include "lf/densify/demosaic/pixel_places.h"

namespace lf {

struct JointNeighbour {
  const JointImage* image = nullptr;
  PixelPlaces places;
  PixelPlaces::Offsets offsets;  // OffsetsIn() the target
  float nearness = 1;            // factor of the weights of its samples
  double shift_px = 0;           // ShiftPerInverseDepth()
};

struct JointTarget {
  const JointImage* image = nullptr;
  const IdealPositions* ideal = nullptr;
  const Image<float>* inverse_depths = nullptr;  // [height][width]
  std::span<const JointNeighbour> neighbours;
  // DemosaickedWithOtherPattern(), and which pixels are compared with it; see JointTile::tested.
  const Image<float>* other = nullptr;
  const Image<uint8_t>* is_tested = nullptr;  // [height][width]: 0 or 1
};

struct JointTile {
  PixelRect rect;
  Image<float> rgb;  // [height][width][3]
  // [height][width]: for each tested pixel, the value of the colour that it recorded, found as
  // above from JointTarget::other in place of D and without the recorded value. Unspecified for
  // others.
  Image<float> tested;
};

// Computes the pixels `rect` of the target.
JointTile MergeTile(const JointTarget& target, const PixelRect& rect);

}  // namespace lf
