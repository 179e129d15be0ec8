// SPDX-License-Identifier: Apache-2.0
// The writers of PNG, TIFF, JPEG and EXR files. They encode in memory. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Number of rows that are made and encoded at a time, and of the rows in a strip of a TIFF file. It
// is a multiple of the rows in a block of EXR's compression (16 or 1), so that the bytes of an EXR
// file do not depend on this number. Encoding this many rows of 8192 pixels takes about 0.1 s.
inline constexpr int kBlockRows = 32;

inline constexpr double kLargestClassicTiff_bytes = 4000.0 * 1024 * 1024;

// A picture whose rows are made while it is encoded.
struct PictureRows {
  std::string name;  // name of the file, for messages
  int width = 0;
  int height = 0;
  int channels = 0;
  PixelType type = PixelType::kUint8;  // type of all channels; not kHalf
  bool is_srgb = false;                // true: a PNG file states that its values are sRGB
  ImageMetadata metadata = {};
  // Writes the values of row y to `to`, [x][channel] without gaps.
  std::function<void(int y, std::byte* to)> pack_row;
  // Called before every kBlockRows rows; the encoding ends if it returns true. May be empty.
  std::function<bool()> is_interrupted = {};
};

// These functions return the bytes of a file. Equal pictures give equal bytes. kOutput: the library
// reports an error. kInterrupted: is_interrupted() returned true.
//
// PNG has 1 to 4 channels of kUint8 or kUint16, and one text for each entry of the metadata.
Result<std::string> EncodePng(const PictureRows& picture);
// TIFF has any number of channels of kUint8, kUint16 or kFloat. Its description holds one line for
// each entry of the metadata: "lf.time_s: 0.25". Pictures of more than `largest_classic_bytes`,
// before they are compressed, become BigTIFF, because offsets in classic TIFF files have 32 bits.
Result<std::string> EncodeTiff(const PictureRows& picture,
                               double largest_classic_bytes = kLargestClassicTiff_bytes);
// JPEG has 1 or 3 channels of kUint8, quality 95 and full chroma resolution. Its comment holds the
// same lines as the description of a TIFF file.
Result<std::string> EncodeJpegRows(const PictureRows& picture);
// EXR keeps the types of metadata. The channels must have the same size.
Result<std::string> EncodeExr(const std::string& name, std::span<const ExrChannel> channels,
                              const ImageMetadata& metadata, ExrCompression compression,
                              const std::function<bool()>& is_interrupted);

// Returns the value of an entry of the metadata as text.
std::string TextOf(const MetadataValue& value);

// Returns one line for each entry of the metadata: "lf.frame: 12\nlf.time_s: 0.25\n".
std::string LinesOf(const ImageMetadata& metadata);

}  // namespace lf
