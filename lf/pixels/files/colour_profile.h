// SPDX-License-Identifier: Apache-2.0
// The colour profiles (ICC) of image files. Photographs of phones are mostly in Display P3, whose
// numbers mean stronger colours than those of sRGB. No other folder uses Little CMS.
//
// All functions may be called by many threads at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Returns the profile that a file states: PNG, JPEG, TIFF, WebP, JPEG XL, HEIF, JPEG 2000 or BMP;
// "" if there is none. Reads the header alone. Errors as for ReadImageInfo().
Result<std::string> ReadIccProfile(const std::filesystem::path& path);

// Returns the description that a profile states, such as "Display P3", cut to 80 characters; "" if
// the bytes are no profile.
std::string NameOfProfile(std::string_view icc);

// Returns true if the bytes are a profile of RGB colours whose values differ from those of sRGB by
// more than one step of 8 bits somewhere.
bool IsOtherThanSrgb(std::string_view icc);

// Converts the first three channels of a picture of 8 or 16 bits from the profile to sRGB, if
// IsOtherThanSrgb(): relative colorimetric, and clipped to the colours that sRGB has. Other
// channels, and pictures of floats or of fewer channels, stay as they are. Returns true if it
// converted.
bool ConvertToSrgb(std::string_view icc, StoredImage* image);

}  // namespace lf
