// SPDX-License-Identifier: Apache-2.0
// Checks the structure of an image file before a decoder reads it. Internal to this folder.
//
// Decoders allocate as much memory as the size in a header requires, and some do so when they open
// the file (progressive JPEG). They also differ in how they handle a file that ends early.
// Therefore the sizes that a header claims are checked first.
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/result.h"
#include "lf/pixels/files/file_bytes.h"

namespace lf {

enum class ImageFormat {
  kPng,
  kJpeg,
  kTiff,
  kExr,
  kRaw,
  // The formats from here on are read but not written.
  kNetpbm,
  kPfm,
  kBmp,
  kRadiance,
  kWebp,
  kJpeg2000,
  kJpegXl,
  kHeif
};

// Returns "PNG", "JPEG", "TIFF", "EXR", "raw" and so on.
const char* NameOf(ImageFormat format);

// Largest number of pixels of an image that is read.
inline constexpr uint64_t kMaxImagePixels = uint64_t{1} << 30;

// Returns the format, which it detects by the content. kRaw is a camera raw file. A TIFF file is
// kRaw if it is a DNG or a Canon CR2, or if it begins with a thumbnail, because a TIFF decoder
// would show the thumbnail. kInput: the file is empty, or its format is not read here (the message
// names formats that pictures often have, such as GIF); a PNG or
// JPEG ends before its size is stated, or claims more than kMaxImagePixels or more than a file of
// its length can hold; a PNG claims a chunk before its pixels that is longer than the file.
Result<ImageFormat> ProbeImage(const ByteSource& source, const std::string& name);

// kInput if an image has more pixels than kMaxImagePixels.
Result<void> CheckPixelCount(uint64_t width, uint64_t height, const std::string& name);

// kInput if a PNG file ends before its end mark, or within a chunk.
Result<void> CheckPngIsComplete(const ByteSource& source, const std::string& name);

}  // namespace lf
