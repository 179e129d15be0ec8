// SPDX-License-Identifier: Apache-2.0
// Decides where an LF image takes colours from its neighbours, and where it stays demosaicked by
// itself, because its pose is wrong, something moved, or surfaces glitter. Internal to this folder.
//
// The judge are recorded values. A quarter of the pixels is tested: the colour that a pixel
// recorded is interpolated from its own LF image (DemosaickedWithOtherPattern()) and found in the
// neighbours without its value (JointTile::tested). In blocks of 32 x 32 pixels, the way with the
// smaller error is taken. The border between blocks of both kinds is a ramp from the middle of one
// block to that of the next.
#pragma once

#include <cstdint>

#include "lf/core/image.h"
#include "lf/densify/demosaic/joint_image.h"

namespace lf {

inline constexpr int kGuardBlock_px = 32;

// Sums of squared errors of tested pixels, in white balanced radiance.
struct GuardErrors {
  double single = 0;  // of LF images demosaicked by themselves
  double joint = 0;   // of colours from their neighbours
  double kept = 0;    // of the way that each block takes
  uint64_t count = 0;
  uint64_t block_count = 0, joint_block_count = 0;  // joint: blocks that take colours of neighbours

  GuardErrors& operator+=(const GuardErrors& other);
};

// Returns which pixels of an LF image are tested, [height][width]: 1 for a quarter of them, which
// depends on `seed` alone.
Image<uint8_t> TestedPixels(uint64_t seed, int width, int height);

// Mixes `joint` and image.rgb block by block, and writes the result to `joint`.
//   other   DemosaickedWithOtherPattern()
//   tested  JointTile::tested of the whole LF image
GuardErrors ApplyGuard(const JointImage& image, const Image<float>& other,
                       const Image<uint8_t>& is_tested, const Image<float>& tested,
                       Image<float>* joint);

}  // namespace lf
