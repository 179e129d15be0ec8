// Image files in and out: PNG, JPEG, TIFF, EXR. The only place with OpenImageIO.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// What a file holds, in the type it is stored in: integers of up to 8 bits as uint8_t (scaled to
// the full range), of up to 16 as uint16_t, half and float as float.
using StoredImage = std::variant<Image<uint8_t>, Image<uint16_t>, Image<float>>;

struct ImageFileInfo {
  int width = 0;
  int height = 0;
  int channels = 0;
  int bits = 0;  // 8, 16 or 32 of the StoredImage
  bool is_float = false;
};

// The header alone. kInput as for ReadImage.
Result<ImageFileInfo> ReadImageInfo(const std::filesystem::path& path);

// All pixels and channels as stored: no colour conversion, alpha not multiplied in, no rotation.
// Channels of EXR files come in the order R, G, B, A, then the others.
// kInput: missing, unreadable or truncated file, or larger than 2^30 pixels; the message names it.
Result<StoredImage> ReadImage(const std::filesystem::path& path);

enum class PixelType { kUint8, kUint16, kHalf, kFloat };

// Written into the file where its format can hold it (EXR: all; PNG, TIFF, JPEG: as text).
using ImageMetadata = std::vector<std::pair<std::string, std::variant<std::string, double, int>>>;

// Writes `pixels` atomically (core/file.h); the extension of `path` chooses the format. Integer
// types take values in [0, 1], clipped and rounded; floats are written as they are.
//   channel_names  one per channel, as EXR shows them; other formats ignore the names
//   type           kUint8 (PNG, JPEG, TIFF), kUint16 (PNG, TIFF), kHalf and kFloat (EXR)
// kOutput: the folder, the disk, or a format that cannot hold the type.
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const float> pixels,
                        const std::vector<std::string>& channel_names, PixelType type,
                        const ImageMetadata& metadata = {});

// Integers exactly as they are, 8 or 16 bits.
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const uint8_t> pixels);
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const uint16_t> pixels);

}  // namespace lf
