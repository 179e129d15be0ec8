// SPDX-License-Identifier: Apache-2.0
// Facts about the pixels of a camera raw file, from LibRaw. Internal to this folder.
#pragma once

#include <libraw/libraw.h>

#include "lf/core/image.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Returns the Bayer pattern that begins at the pixel (x, y) of the sensor; kNone if the colours are
// not in one of the four Bayer patterns. The filter of `raw` must repeat every 2 x 2 pixels.
BayerPattern PatternAt(LibRaw& raw, int x, int y);

// True if the colour filter repeats every 2 x 2 pixels.
bool RepeatsEveryTwo(LibRaw& raw);

// Returns all facts except `bayer` and `is_monochrome`. The levels of a DNG come from its tags: the
// pixels of the sensor that are covered from light and the exposure that a converter recommends do
// not change them (DNG 1.4, chapter 4). The levels of other files are LibRaw's; their black level
// is missing unless is_unpacked is true, which states that LibRaw has decoded the pixels.
RawFacts FactsOf(const libraw_data_t& raw, bool is_unpacked);

// Converts LibRaw's `flip` to an EXIF orientation, 1 to 8.
int OrientationOf(int flip);

}  // namespace lf
