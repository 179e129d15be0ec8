// Image files in and out: PNG, JPEG, TIFF, EXR; camera raw files in. The only place with
// OpenImageIO, libjpeg and LibRaw.
//
// All functions may be called by many threads at once; none starts threads of its own.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// What a file holds, in the type it is stored in: integers of up to 8 bits as uint8_t, of up to 16
// as uint16_t (depths between are scaled to the full range), half and float as float. Wider or
// signed integers, and the integer channels of an EXR file that also holds others, become floats
// of the same value (exact up to 2^24); doubles are rounded to float.
using StoredImage = std::variant<Image<uint8_t>, Image<uint16_t>, Image<float>>;

// What a camera raw file tells of its pixels, in the words of capture/radiance.h.
struct RawFacts {
  BayerPattern bayer =
      BayerPattern::kNone;            // at pixel (0, 0); kNone: not told, or no Bayer pattern
  bool is_monochrome = false;         // no colour filter: the pixels are a grey picture
  std::optional<double> black_level;  // the mean, where the file has several
  std::optional<double> white_level;
  std::optional<std::array<double, 3>> white_balance;  // as shot; green is 1
  std::optional<Mat3> camera_to_srgb;                  // of white balanced colours
};

struct ImageFileInfo {
  int width = 0;
  int height = 0;
  int channels = 0;
  int bits = 0;  // 8, 16 or 32 of the StoredImage
  bool is_float = false;
  std::vector<std::string> channel_names;  // one per channel, as the format calls them
  int orientation = 1;                     // EXIF's, 1 to 8; the pixels stay as stored
  std::optional<RawFacts> raw;             // of camera raw files: one channel of 16 bits
};

// The header alone. kInput as for ReadImage, but a file truncated later goes unnoticed. The black
// level of camera raw files other than DNG is not in it: it is measured on covered pixels.
Result<ImageFileInfo> ReadImageInfo(const std::filesystem::path& path);

// All pixels and channels as stored: no colour conversion, alpha not multiplied in, no rotation.
// The content decides the format, not the name. The first part of a file with several.
// Channels of EXR files come in the order R, G, B, A, then the others; where there are none of
// these names, but one layer has them (beauty.R), its come first. Several such layers are an error.
// Camera raw files give the mosaic as the sensor recorded it, and what a monochrome sensor recorded
// as grey: not demosaicked, brightened, balanced or turned, black not subtracted; cut to the pixels
// that see light (the active area of a DNG), and through the linearization table of a DNG. LibRaw
// decodes them: small damage within compressed ones may go unnoticed, and pictures below 22 pixels
// are no raw files to it.
// kInput: missing, unreadable, truncated or damaged file (JPEG: whatever libjpeg could only guess),
// another format (raw files without a Bayer mosaic among them), a CMYK JPEG, or larger than 2^30
// pixels or 2^32 values, which is checked before pixels are allocated; the message names the file.
Result<StoredImage> ReadImage(const std::filesystem::path& path);

// Both at once.
struct ImageWithInfo {
  StoredImage image;
  ImageFileInfo info;
};
Result<ImageWithInfo> ReadImageWithInfo(const std::filesystem::path& path);

// A part of a picture: `image` holds its pixels `rect`, info is of the whole.
struct ImagePart {
  StoredImage image;
  PixelRect rect;
  ImageFileInfo info;
};

// Which pixels are needed, asked once the header is known. An error ends the reading.
using WantedPixels = std::function<Result<PixelRect>(const ImageFileInfo& info)>;

// At least the wanted pixels, which are some within the picture; the same as ReadImage gives there.
// JPEG files are decoded in part where this saves time, others as a whole; damage is found anywhere
// in the file all the same. The memory of part->image is used again if it has the same type, as
// getting it from the system costs as much as a third of the decoding.
Result<void> ReadImagePart(const std::filesystem::path& path, const WantedPixels& wanted,
                           ImagePart* part);

// The same for a file that is in memory; `name` is what messages call it.
Result<ImageFileInfo> ReadImageInfoBytes(std::string_view bytes, const std::string& name);
Result<StoredImage> ReadImageBytes(std::string_view bytes, const std::string& name);
Result<ImageWithInfo> ReadImageWithInfoBytes(std::string_view bytes, const std::string& name);
Result<void> ReadImagePartBytes(std::string_view bytes, const std::string& name,
                                const WantedPixels& wanted, ImagePart* part);

enum class PixelType { kUint8, kUint16, kHalf, kFloat };

// Written into the file where its format can hold it (EXR: all; PNG, TIFF, JPEG: as text).
using ImageMetadata = std::vector<std::pair<std::string, std::variant<std::string, double, int>>>;

// Writes `pixels` atomically (core/file.h); the extension of `path` chooses the format. Integer
// types take values in [0, 1], clipped (NaN: 0) and rounded to nearest; they are sRGB for display,
// and PNG files say so. Floats are written as they are; what half cannot hold becomes infinite.
// The same pixels give the same bytes: no date is written.
//   channel_names  one per channel, as EXR shows them; other formats ignore the names
//   type           kUint8 (PNG, JPEG, TIFF), kUint16 (PNG, TIFF), kHalf (EXR), kFloat (EXR, TIFF)
//   is_interrupted asked before every 32 rows are encoded, if given; the disk is waited for
// JPEG has quality 95 and full chroma resolution. EXR is compressed without loss (zip).
// kOutput: the folder, the disk, or a format that cannot hold the type. kInterrupted: nothing is
// written.
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const float> pixels,
                        const std::vector<std::string>& channel_names, PixelType type,
                        const ImageMetadata& metadata = {},
                        const std::function<bool()>& is_interrupted = {});

// Integers exactly as they are, 8 or 16 bits, without a word on their colour space.
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const uint8_t> pixels);
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const uint16_t> pixels);

// One channel of an EXR file with a type of its own: floats as half or float, or 32-bit integers.
struct ExrChannel {
  std::string name;
  std::variant<ImageView<const float>, ImageView<const uint32_t>> pixels;
  int channel = 0;      // of `pixels`
  bool as_half = true;  // floats only
};

// Writes channels of one size as one EXR file, as WriteImage does. kOutput: the folder, the disk,
// an extension other than .exr. kInterrupted.
Result<void> WriteExr(const std::filesystem::path& path, std::span<const ExrChannel> channels,
                      const ImageMetadata& metadata = {},
                      const std::function<bool()>& is_interrupted = {});

}  // namespace lf
