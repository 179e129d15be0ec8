// SPDX-License-Identifier: Apache-2.0
// Chooses one inverse depth for each pixel such that the costs are low and the depth changes little
// from pixel to pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/image.h"
#include "lf/densify/matching_costs.h"
#include "lf/densify/plane_set.h"
#include "lf/densify/watched_loop.h"

namespace lf {

// The costs of a rectangle of pixels, in blocks of their own planes.
struct CostBlocks {
  struct Block {
    PlaneSet planes;
    MatchingCosts costs;  // an entry of the set is an inverse depth of the costs
  };
  PixelRect rect;
  // Blocks have this many columns and rows; the last ones may have fewer.
  int side = 0;
  std::vector<Block> blocks;  // row by row

  static int CountAlong(int size, int side) { return (size + side - 1) / side; }
};

// The chosen places of the pixels of MatchingCosts::rect or CostBlocks::rect.
struct ChosenPlanes {
  // Between 0, the first plane, and planes - 1, the last one; interpolated by a parabola through
  // the sums of three planes.
  Image<float> place;
  Image<uint8_t> cost;  // matching cost of the nearest plane
  // Least sum of the planes more than two away from the chosen one, minus its sum, relative to the
  // number of paths: how clearly the plane is better than others. Left empty unless asked for.
  Image<uint16_t> lead;
};

// Semi-global matching in integers (Hirschmueller, "Stereo processing by semiglobal matching and
// mutual information", PAMI 2008): adds, for each pixel and plane, the least costs of eight
// straight paths that end there. A step to the next plane costs kSmallStep; a larger step costs
// kLargeStep, or less where the image has an edge, but more than kSmallStep.
inline constexpr int kSmallStep = 24;
inline constexpr int kLargeStep = 480;

//   tones        of the whole reference image
//   interrupted  once it is set, the result must not be used
ChosenPlanes ChoosePlanes(const MatchingCosts& costs, const Image<uint16_t>& tones, bool with_lead,
                          InterruptFlag interrupted = nullptr);
// As above. A path goes from block to block; planes that a block does not have are not chosen
// there.
ChosenPlanes ChoosePlanes(const CostBlocks& blocks, const Image<uint16_t>& tones,
                          InterruptFlag interrupted = nullptr);

}  // namespace lf
