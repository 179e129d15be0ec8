// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <type_traits>

#include "lf/core/file.h"
#include "lf/core/value_named.h"
#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/picture_encoder.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/pixels/files/whole_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

std::string LowerCaseExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

Result<ImageFormat> FormatOf(const fs::path& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".png") return ImageFormat::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::kJpeg;
  if (extension == ".tif" || extension == ".tiff") return ImageFormat::kTiff;
  if (extension == ".exr") return ImageFormat::kExr;
  return OutputError(
      fmt::format("{}: no image format has the extension \"{}\"; use .png, .jpg, .tif or .exr",
                  path.string(), extension));
}

Result<void> CheckHolds(const fs::path& path, ImageFormat format, PixelType type, int channels) {
  const bool integer = type == PixelType::kUint8 || type == PixelType::kUint16;
  const bool holds = (format == ImageFormat::kExr && !integer) ||
                     (format == ImageFormat::kJpeg && type == PixelType::kUint8) ||
                     (format == ImageFormat::kPng && integer) ||
                     (format == ImageFormat::kTiff && type != PixelType::kHalf);
  const bool holds_channels = (format != ImageFormat::kPng || channels <= 4) &&
                              (format != ImageFormat::kJpeg || channels == 1 || channels == 3);
  if (!holds_channels)
    return OutputError(fmt::format("{}: {} files cannot hold {} channels; choose another extension",
                                   path.string(), NameOf(format), channels));
  if (holds) return {};
  constexpr const char* kTypes[] = {"8-bit integers", "16-bit integers", "half floats", "floats"};
  return OutputError(fmt::format("{}: {} files cannot hold {}; choose another extension",
                                 path.string(), NameOf(format), kTypes[static_cast<int>(type)]));
}

// Writes an encoded picture to the disk. Pictures are encoded in memory, so that core/file.h
// detects every failure of the disk.
Result<void> Save(const fs::path& path, const Result<std::string>& bytes) {
  if (!bytes) return bytes.error();
  const FileBytes file = FileInMemory(*bytes, path.string());
  // OpenEXR omits blocks without an error if memory runs out in one of its destructors.
  if (const Result<void> whole = CheckIsWhole(file.read, file.size_bytes, file.name); !whole)
    return OutputError(
        fmt::format("{}: cannot be written, because the encoder left out a part of the picture, "
                    "probably for lack of memory ({}): give the program more memory",
                    file.name, whole.error().message));
  return WriteFileAtomically(path, *bytes);
}

Result<std::string> Encode(ImageFormat format, const PictureRows& picture) {
  switch (format) {
    case ImageFormat::kPng:
      return EncodePng(picture);
    case ImageFormat::kTiff:
      return EncodeTiff(picture);
    case ImageFormat::kJpeg:
      return EncodeJpegRows(picture);
    default:
      LF_CHECK(false);
  }
}

// Returns a picture of the pixels. `convert` converts each of their values to type To.
template <class To, class From, class Convert>
PictureRows RowsOf(const fs::path& path, ImageView<const From> pixels, PixelType type,
                   const Convert& convert) {
  PictureRows picture;
  picture.name = path.string();
  picture.width = pixels.width;
  picture.height = pixels.height;
  picture.channels = pixels.channels;
  picture.type = type;
  const size_t row_values = static_cast<size_t>(pixels.width) * pixels.channels;
  picture.pack_row = [=](int y, std::byte* to) {
    for (const From* value = pixels.row(y); value < pixels.row(y) + row_values; ++value) {
      const To converted = convert(*value);
      std::memcpy(to, &converted, sizeof(To));
      to += sizeof(To);
    }
  };
  return picture;
}

// Clips a value to [0, 1] and rounds it to an integer from 0 to the largest T. NaN compares false
// and becomes 0.
template <class T>
T IntegerOf(float value) {
  constexpr double kMax = std::numeric_limits<T>::max();
  const double clipped = value > 0 ? std::min<double>(value, 1) : 0;
  return static_cast<T>(std::floor(clipped * kMax + 0.5));
}

Result<void> CheckShape(const fs::path& path, int width, int height) {
  if (width > 0 && height > 0) return {};
  return OutputError(
      fmt::format("{}: a picture of {} x {} pixels cannot be written: expected at least 1 x 1",
                  path.string(), width, height));
}

template <class T>
Result<void> WriteStored(const fs::path& path, ImageView<const T> pixels, PixelType type) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, FormatOf(path));
  LF_RETURN_IF_ERROR(CheckHolds(path, format, type, pixels.channels));
  LF_RETURN_IF_ERROR(CheckShape(path, pixels.width, pixels.height));
  const auto as_it_is = [](T value) { return value; };
  return Save(path, Encode(format, RowsOf<T>(path, pixels, type, as_it_is)));
}

}  // namespace

Result<void> WriteImage(const fs::path& path, ImageView<const float> pixels,
                        const std::vector<std::string>& channel_names, PixelType type,
                        const ImageMetadata& metadata, const std::function<bool()>& is_interrupted,
                        bool is_srgb) {
  LF_CHECK(channel_names.size() == static_cast<size_t>(pixels.channels));
  LF_ASSIGN_OR_RETURN(const ImageFormat format, FormatOf(path));
  LF_RETURN_IF_ERROR(CheckHolds(path, format, type, pixels.channels));
  LF_RETURN_IF_ERROR(CheckShape(path, pixels.width, pixels.height));
  if (format != ImageFormat::kExr) {
    PictureRows picture =
        type == PixelType::kUint8    ? RowsOf<uint8_t>(path, pixels, type, IntegerOf<uint8_t>)
        : type == PixelType::kUint16 ? RowsOf<uint16_t>(path, pixels, type, IntegerOf<uint16_t>)
                                     : RowsOf<float>(path, pixels, type, [](float v) { return v; });
    picture.is_srgb = is_srgb && type != PixelType::kFloat;
    picture.metadata = metadata;
    picture.is_interrupted = is_interrupted;
    return Save(path, Encode(format, picture));
  }
  std::vector<ExrChannel> channels;
  for (int channel = 0; channel < pixels.channels; ++channel)
    channels.push_back({channel_names[channel], pixels, channel, type == PixelType::kHalf});
  return WriteExr(path, channels, metadata, is_interrupted);
}

Result<void> WriteImage(const fs::path& path, ImageView<const uint8_t> pixels) {
  return WriteStored(path, pixels, PixelType::kUint8);
}

Result<void> WriteImage(const fs::path& path, ImageView<const uint16_t> pixels) {
  return WriteStored(path, pixels, PixelType::kUint16);
}

Result<void> WriteStoredImage(const fs::path& path, const StoredImage& pixels,
                              const std::vector<std::string>& channel_names,
                              const ColourFacts& colours, const ImageMetadata& metadata,
                              const std::function<bool()>& is_interrupted) {
  ImageMetadata all = metadata;
  if (colours.chromaticities) all.emplace_back("chromaticities", *colours.chromaticities);
  if (const auto* floats = std::get_if<Image<float>>(&pixels)) {
    if (colours.frames_per_second)
      all.emplace_back("framesPerSecond", FrameRate{*colours.frames_per_second});
    return WriteImage(path, floats->view(), channel_names, colours.type, all, is_interrupted);
  }
  if (colours.frames_per_second) all.emplace_back(kFrameRateText, *colours.frames_per_second);
  return std::visit(
      [&](const auto& image) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const ImageFormat format, FormatOf(path));
        LF_RETURN_IF_ERROR(CheckHolds(path, format, colours.type, image.channels()));
        LF_RETURN_IF_ERROR(CheckShape(path, image.width(), image.height()));
        using Value = std::remove_cvref_t<decltype(image.at(0, 0))>;
        LF_CHECK(sizeof(Value) == (colours.type == PixelType::kUint16 ? 2 : 1));
        PictureRows picture =
            RowsOf<Value>(path, image.view(), colours.type, [](Value value) { return value; });
        picture.is_srgb = colours.is_srgb;
        picture.metadata = all;
        picture.is_interrupted = is_interrupted;
        return Save(path, Encode(format, picture));
      },
      pixels);
}

std::optional<ExrCompression> ParseExrCompression(std::string_view name) {
  return ValueNamed(name, {ExrCompression::kZip, ExrCompression::kZips});
}

const char* NameOf(ExrCompression compression) {
  return compression == ExrCompression::kZip ? "zip" : "zips";
}

Result<void> WriteExr(const fs::path& path, std::span<const ExrChannel> channels,
                      const ImageMetadata& metadata, const std::function<bool()>& is_interrupted,
                      ExrCompression compression) {
  LF_CHECK(!channels.empty());
  if (LowerCaseExtension(path) != ".exr")
    return OutputError(fmt::format("{}: an EXR file needs the extension .exr", path.string()));
  const auto size = [](const ExrChannel& channel) {
    return std::visit([](const auto& view) { return std::pair(view.width, view.height); },
                      channel.pixels);
  };
  const auto [width, height] = size(channels[0]);
  LF_RETURN_IF_ERROR(CheckShape(path, width, height));
  for (const ExrChannel& channel : channels) LF_CHECK(size(channel) == std::pair(width, height));
  return Save(path, EncodeExr(path.string(), channels, metadata, compression, is_interrupted));
}

}  // namespace lf
