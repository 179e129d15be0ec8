// What the structure of an image file tells before a decoder sees it. Internal to this folder.
//
// Decoders allocate by what a header claims, and some (progressive JPEG) do so on opening; and
// they differ in how they take a file that ends early. So the claims are looked at first.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "lf/core/result.h"

namespace lf {

// Copies bytes from `offset` on into `to`; gives how many there were.
using ByteSource = std::function<size_t(uint64_t offset, std::span<uint8_t> to)>;

enum class ImageFormat { kPng, kJpeg, kTiff, kExr, kRaw };

// By content. kRaw: a file as cameras write them. A TIFF file is one if it is a DNG, or leads with
// a thumbnail, which would pass as TIFF and show the thumbnail. kInput: a format that is not read
// here, or a PNG or JPEG that claims more than kMaxImagePixels, or more than a file of its length
// can hold, or a PNG that claims a longer chunk before its pixels than the file has bytes.
inline constexpr uint64_t kMaxImagePixels = uint64_t{1} << 30;
Result<ImageFormat> ProbeImage(const ByteSource& source, const std::string& name);

// kInput for an image of more pixels than are read here.
Result<void> CheckPixelCount(uint64_t width, uint64_t height, const std::string& name);

// kInput if the chunks of a PNG do not reach their end mark.
Result<void> CheckPngIsComplete(const ByteSource& source, const std::string& name);

}  // namespace lf
