// Facts that the structure of an image file tells before a decoder reads it. Internal to this
// folder.
//
// Decoders allocate memory by the claims of a header, and some do so when they open the file
// (progressive JPEG). They also differ in how they handle a file that ends early. Therefore the
// claims are checked first.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "lf/core/result.h"

namespace lf {

// Copies the bytes from `offset` on into `to`; returns how many there were.
using ByteSource = std::function<size_t(uint64_t offset, std::span<uint8_t> to)>;

enum class ImageFormat { kPng, kJpeg, kTiff, kExr, kRaw };

// Tells the format by the content. kRaw is a file as cameras write it. A TIFF file is kRaw if it is
// a DNG, or if it begins with a thumbnail, because a TIFF decoder would show the thumbnail. kInput:
// the format is not read here; a PNG or JPEG claims more than kMaxImagePixels or more than a file
// of its length can hold; a PNG claims a chunk before its pixels that is longer than the file.
inline constexpr uint64_t kMaxImagePixels = uint64_t{1} << 30;
Result<ImageFormat> ProbeImage(const ByteSource& source, const std::string& name);

// kInput if an image has more pixels than kMaxImagePixels.
Result<void> CheckPixelCount(uint64_t width, uint64_t height, const std::string& name);

// kInput if the chunks of a PNG do not reach their end mark.
Result<void> CheckPngIsComplete(const ByteSource& source, const std::string& name);

}  // namespace lf
