// SPDX-License-Identifier: Apache-2.0
// Reads the orientation from Exif data within another file. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>

namespace lf {

// Returns the orientation, 1 to 8, that the first directory of a TIFF file states; 1 if it states
// none, or another number.
int OrientationOfTiff(std::span<const uint8_t> tiff);

// Returns the orientation in an APP1 segment of a JPEG file; 1 if there is none. `segment` is the
// content of the segment: "Exif", two zeros and a TIFF file, or anything else.
int OrientationOfExif(std::span<const uint8_t> segment);

}  // namespace lf
