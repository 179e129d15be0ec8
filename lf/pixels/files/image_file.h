// SPDX-License-Identifier: Apache-2.0
// Reads image files (doc/formats/images.md lists the formats) and writes PNG, JPEG, TIFF and EXR
// files. No other folder uses the libraries of image formats.
//
// Paths may also name a view of a picture, such as mosaic.png#160x120+320+240 (picture_view.h).
//
// All functions may be called by many threads at once; none starts threads of its own, but
// libraries of HEIF files may.
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
#include "lf/pixels/files/exr_compression.h"

namespace lf {

// Pixels of a file, in the type it stores: integers of up to 8 bits as uint8_t, of up to 16 bits as
// uint16_t (other numbers of bits than 8 and 16 are scaled to the full range, except in camera raw
// files), half and float as float. Wider or signed integers become floats of equal value (exact up
// to 2^24), and doubles are rounded to float. If one channel becomes float, all channels do.
using StoredImage = std::variant<Image<uint8_t>, Image<uint16_t>, Image<float>>;

// Properties of the pixels that a camera raw file states, in the terms of
// light_field/model/radiance.h.
struct RawFacts {
  BayerPattern bayer =
      BayerPattern::kNone;     // pattern from pixel (0, 0) on; kNone: no Bayer pattern stated
  bool is_monochrome = false;  // no colour filter: the pixels are a grey picture
  std::optional<double> black_level;  // in raw pixel values; the mean, if the file has several
  std::optional<double> white_level;  // in raw pixel values
  std::optional<std::array<double, 3>> white_balance;  // factors of R, G, B as shot; green is 1
  std::optional<Mat3> linear_srgb_from_camera;         // matrix for white-balanced colours
};

struct ImageFileInfo {
  int width = 0;
  int height = 0;
  int channels = 0;
  int bits = 0;  // 8, 16 or 32: bits of a value of the StoredImage
  bool is_float = false;
  std::vector<std::string> channel_names;  // name of each channel, such as R, Y or beauty.R
  int orientation = 1;                     // EXIF orientation, 1 to 8; the pixels stay as stored
  std::optional<RawFacts> raw;             // set only for camera raw files: 1 channel, 16 bits
};

// Reads the header alone. Errors are as for ReadImage(), except that damage behind the header is
// not detected. For camera raw files other than DNG the black level is missing, because LibRaw
// measures it on covered pixels of the sensor.
Result<ImageFileInfo> ReadImageInfo(const std::filesystem::path& path);

// Reads all pixels and channels as stored: no colour conversion, no multiplication by alpha, no
// rotation. The content decides the format, not the name. If a file has several parts, the first is
// read; those that follow in an EXR file must hold no picture.
// - EXR: channels come in the order R, G, B, A, then the others. If no channel is named R, G or B,
//   but one layer has all three (beauty.R), the channels of this layer come first. It is an error
//   if several layers have all three.
// - Camera raw: gives the mosaic as the sensor recorded it, or grey if the sensor is monochrome. It
//   is not demosaicked, brightened, white balanced or rotated, and the black level is not
//   subtracted. It is cropped to the pixels that see light (the active area of a DNG) and mapped
//   through the linearization table of a DNG. LibRaw decodes these files. It may not detect small
//   damage within compressed pixels, and does not accept pictures below 22 pixels in width or
//   height.
// - Netpbm: values are scaled from the stated white to the full range. PFM and Radiance: floats as
//   stored. JPEG XL: floats, or integers of up to 16 bits. HEIF: turned as the file says, because
//   this is part of the picture there.
// kInput, naming the file: it is missing, unreadable, truncated or damaged (JPEG: also if libjpeg
// had to guess pixels); its format needs a library that is missing (picture_decoder.h); it has
// another format, or pixels of a kind that is not read, such as CMYK colours, deep data, or a raw
// mosaic that is not Bayer (the message says which); it is an EXR file of several pictures, such as
// a focus stack, which means that several parts have channels R, G and B; it is larger than 4 GiB,
// 2^30 pixels or 2^32 values, which is checked before pixels are allocated. kOutput: the machine
// lacks something (KindOfReadFailure() of core/file.h).
Result<StoredImage> ReadImage(const std::filesystem::path& path);

// Reads pixels and header at once.
struct ImageWithInfo {
  StoredImage image;
  ImageFileInfo info;
};
Result<ImageWithInfo> ReadImageWithInfo(const std::filesystem::path& path);

// A part of a picture. `image` holds the pixels of `rect`; `info` describes the whole picture.
struct ImagePart {
  StoredImage image;
  PixelRect rect;
  ImageFileInfo info;
  // The colour profile that the file states (colour_profile.h); "" if none.
  std::string icc_profile = {};
};

// Called after the header is read; returns the pixels that are needed. If it returns an error,
// reading ends with this error.
using WantedPixels = std::function<Result<PixelRect>(const ImageFileInfo& info)>;

// Reads at least the wanted pixels, which must contain a pixel of the picture. They have the values
// that ReadImage() gives. JPEG, Netpbm, PFM and BMP files are decoded in part if this saves time,
// files of other formats as a whole; damage is detected anywhere in the file in both cases. Reuses
// the memory of part->image if it has the right type, because allocating it costs up to a third of
// the decoding time.
Result<void> ReadImagePart(const std::filesystem::path& path, const WantedPixels& wanted,
                           ImagePart* part);

// These functions read a file that is in memory; messages call the file `name`.
Result<ImageFileInfo> ReadImageInfoBytes(std::string_view bytes, const std::string& name);
Result<StoredImage> ReadImageBytes(std::string_view bytes, const std::string& name);
Result<ImageWithInfo> ReadImageWithInfoBytes(std::string_view bytes, const std::string& name);
Result<void> ReadImagePartBytes(std::string_view bytes, const std::string& name,
                                const WantedPixels& wanted, ImagePart* part);

enum class PixelType { kUint8, kUint16, kHalf, kFloat };

// A frame rate. EXR files store the nearest fraction, and 30000/1001 for 29.97 (likewise for the
// other rates of NTSC).
struct FrameRate {
  double per_second = 0;
};

// Value of an entry of the metadata. Standard attributes of EXR files have the types from float on:
// 2 floats are a V2f; 8 are chromaticities (x and y of red, green, blue and white); 16 are an M44f,
// row by row, which row vectors are multiplied by.
using MetadataValue = std::variant<std::string, double, int, float, FrameRate, std::array<float, 2>,
                                   std::array<float, 8>, std::array<float, 16>>;

// Keys and values that are written into the file: in EXR with their types, in PNG, TIFF and JPEG as
// text. PNG cuts keys to 79 characters.
using ImageMetadata = std::vector<std::pair<std::string, MetadataValue>>;

// Writes `pixels` atomically (core/file.h); the extension of `path` chooses the format. For integer
// types, the values are sRGB values for display: they are clipped to [0, 1] (NaN becomes 0), scaled
// to the range of the type and rounded to nearest; PNG files state that they are sRGB. Floats are
// written as they are; a value that is too large for half becomes infinite. Equal pixels and
// metadata give equal bytes, because no date is written.
//   channel_names  one per channel, as EXR shows them; other formats ignore the names
//   type           kUint8 (PNG, JPEG, TIFF), kUint16 (PNG, TIFF), kHalf (EXR), kFloat (EXR, TIFF)
//   is_interrupted is called before every 32 rows are encoded, if given; it cannot interrupt the
//                  writing to the disk
//   is_srgb        false: a PNG file does not state that its values are sRGB
// JPEG has quality 95 and full chroma resolution. EXR is compressed without loss (zip).
// kOutput: the folder or the disk fails, no format has the extension, the picture has no pixel, or
// the format cannot hold the type or the number of channels (PNG: 1 to 4, JPEG: 1 or 3).
// kInterrupted: is_interrupted returned true; nothing is written.
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const float> pixels,
                        const std::vector<std::string>& channel_names, PixelType type,
                        const ImageMetadata& metadata = {},
                        const std::function<bool()>& is_interrupted = {}, bool is_srgb = true);

// These functions write integers of 8 or 16 bits without converting them (JPEG holds only 8 bits,
// and is not exact). The file states no colour space. Otherwise they do as WriteImage() above.
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const uint8_t> pixels);
Result<void> WriteImage(const std::filesystem::path& path, ImageView<const uint16_t> pixels);

// One channel of an EXR file, with a type of its own: floats as half or float, or 32-bit integers.
struct ExrChannel {
  std::string name;
  std::variant<ImageView<const float>, ImageView<const uint32_t>> pixels;
  int channel = 0;      // channel index in `pixels`
  bool as_half = true;  // true: floats are stored as half; false: as float
};

// Writes channels of equal size as one EXR file, atomically and with `metadata` as WriteImage()
// does. kOutput: the folder or the disk fails, or the extension is not .exr. kInterrupted:
// is_interrupted returned true; nothing is written.
Result<void> WriteExr(const std::filesystem::path& path, std::span<const ExrChannel> channels,
                      const ImageMetadata& metadata = {},
                      const std::function<bool()>& is_interrupted = {},
                      ExrCompression compression = ExrCompression::kZip);

}  // namespace lf
