// Facts that LibRaw tells of the pixels of a camera raw file. Internal to imageio.
#pragma once

#include <libraw/libraw.h>

#include "lf/core/image.h"
#include "lf/imageio/image_file.h"

namespace lf {

// The pattern at the pixel (x, y) of the sensor; kNone for what is not two greens on a diagonal
// with red and blue. `raw` must have a filter that repeats every 2 x 2 pixels.
BayerPattern PatternAt(LibRaw& raw, int x, int y);

// True if the colour filter repeats every 2 x 2 pixels.
bool RepeatsEveryTwo(LibRaw& raw);

// Returns everything but the pattern. The levels of a DNG are those of its tags: neither covered
// pixels nor the exposure that a converter recommends change them (DNG 1.4, chapter 4). Those of
// other files are LibRaw's, their black level only if they are unpacked.
RawFacts FactsOf(const libraw_data_t& raw, bool is_unpacked);

// EXIF's orientation of LibRaw's `flip`.
int OrientationOf(int flip);

}  // namespace lf
