// SPDX-License-Identifier: Apache-2.0
// Demosaics a strip of columns, from top to bottom. Internal to this folder.
//
// Each step follows the step before it by as many rows as it needs, so that no row is computed
// twice, and the rows that are still needed fit into the L2 cache.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/storage/load/demosaic_arithmetic.h"

namespace lf {

// Memory of DemosaicStrip(), which is used again for the next strip.
struct StripMemory {
  std::vector<float> values;
  std::vector<uint16_t> mosaic, rgb;
};

// The mosaic that is demosaicked.
struct WholeMosaic {
  const LfPixels& pixels;  // a part of the mosaic
  int width, height;       // of the whole LF image
};

// The largest number of columns of a strip.
inline constexpr int kStripColumns = 1024;

// Computes the RGB pixels `strip`, part of rgb->rect, which is at most kStripColumns wide. The
// other parameters are as for Demosaic().
void DemosaicStrip(const WholeMosaic& mosaic, const BalancedLevels& levels, const PixelRect& strip,
                   StripMemory* memory, LfPixels* rgb);

}  // namespace lf
