#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <new>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/open_image_io.h"
#include "lf/pixels/files/stored_value.h"
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
                                   path.string(), PluginName(format), channels));
  if (holds) return {};
  constexpr const char* kTypes[] = {"8-bit integers", "16-bit integers", "half floats", "floats"};
  return OutputError(fmt::format("{}: {} files with {} cannot be written; choose another extension",
                                 path.string(), PluginName(format),
                                 kTypes[static_cast<int>(type)]));
}

std::string TextOf(const std::variant<std::string, double, int>& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<int>(value));
}

// EXR gets attributes with their types, PNG one text for each entry. TIFF and JPEG get lines of the
// description, which is the only text that every reader shows.
void AddMetadata(OIIO::ImageSpec& spec, ImageFormat format, const ImageMetadata& metadata) {
  std::string description;
  for (const auto& [key, value] : metadata) {
    if (format == ImageFormat::kPng) {
      spec.attribute(key, TextOf(value));
    } else if (format == ImageFormat::kExr) {
      std::visit([&, &name = key](const auto& v) { spec[name] = v; }, value);
    } else {
      description += fmt::format("{}: {}\n", key, TextOf(value));
    }
  }
  if (!description.empty()) spec.attribute("ImageDescription", description);
}

OIIO::ImageSpec SpecOf(ImageFormat format, int width, int height, int channels,
                       OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(width, height, channels, type);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // colours are neither multiplied nor divided by
                                                // alpha
  spec.alpha_channel = -1;
  // Moderate compression: stronger compression would make files at most a twentieth smaller, but
  // would take most of a frame's encoding time.
  if (format == ImageFormat::kExr) spec.attribute("compression", "zip:2");
  if (format == ImageFormat::kPng) spec.attribute("png:compressionLevel", 4);
  if (format == ImageFormat::kTiff) spec.attribute("compression", "zip");
  if (format == ImageFormat::kExr || format == ImageFormat::kTiff)
    spec.attribute("DateTime", "");  // today's date would make equal frames differ
  if (format == ImageFormat::kJpeg) {
    spec.attribute("compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  return spec;
}

// Stores row y in the type that the ImageSpec states, without gaps.
using PackRow = std::function<void(int y, std::byte* to)>;

// Number of rows that are encoded at a time: whole blocks of EXR's compression (16) and strips of
// TIFF (32), so that the bytes equal those of a picture encoded at once. Rows of 8192 pixels take
// about 0.1 s.
constexpr int kBlockRows = 32;

ByteSource SourceOf(const std::vector<unsigned char>& bytes) {
  return [&bytes](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= bytes.size()) return 0;
    const size_t count = std::min<size_t>(to.size(), bytes.size() - offset);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), count, to.begin());
    return count;
  };
}

// Encodes the file in memory first, so that core/file.h detects every failure of the disk.
Result<void> Encode(const fs::path& path, ImageFormat format, const OIIO::ImageSpec& spec,
                    const PackRow& pack_row, const std::function<bool()>& is_interrupted) {
  ConfigureOpenImageIo();
  const std::string name = path.string();
  const auto failure = [&](const std::string& reason) {
    return OutputError(fmt::format("{}: cannot be encoded: {}", name, reason));
  };
  std::vector<unsigned char> bytes;
  try {
    OIIO::Filesystem::IOVecOutput file(bytes);
    const auto output = OIIO::ImageOutput::create(PluginName(format));
    if (!output) return failure(OIIO::geterror());
    output->set_ioproxy(&file);
    if (!output->open(name, spec)) return failure(output->geterror());
    const size_t row_bytes = spec.scanline_bytes(true);
    std::vector<std::byte> rows(row_bytes * static_cast<size_t>(std::min(kBlockRows, spec.height)));
    for (int begin = 0; begin < spec.height; begin += kBlockRows) {
      if (is_interrupted && is_interrupted())
        return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", name)};
      const int end = std::min(spec.height, begin + kBlockRows);
      for (int y = begin; y < end; ++y)
        pack_row(y, rows.data() + row_bytes * static_cast<size_t>(y - begin));
      if (!output->write_scanlines(begin, end, 0, OIIO::TypeUnknown, rows.data()))
        return failure(output->geterror());
    }
    if (!output->close()) return failure(output->geterror());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return failure(error.what());
  }
  // If memory runs out in its destructors, OpenEXR reports nothing and omits blocks.
  if (const Result<void> whole = CheckIsWhole(SourceOf(bytes), bytes.size(), name); !whole)
    return OutputError(
        fmt::format("{}: cannot be written, because the encoder left out a part of the picture, "
                    "probably for lack of memory ({}): give the program more memory",
                    name, whole.error().message));
  return WriteFileAtomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// Returns a PackRow that converts each value to To.
template <class To, class From, class Convert>
PackRow Packing(ImageView<const From> pixels, const Convert& convert) {
  const size_t row_values = static_cast<size_t>(pixels.width) * pixels.channels;
  return [=](int y, std::byte* to) {
    for (const From* value = pixels.row(y); value < pixels.row(y) + row_values; ++value) {
      const To converted = convert(*value);
      std::memcpy(to, &converted, sizeof(To));
      to += sizeof(To);
    }
  };
}

// Clips and rounds a value in [0, 1]. NaN compares false and becomes 0.
template <class T>
T IntegerOf(float value) {
  constexpr double kMax = std::numeric_limits<T>::max();
  const double clipped = value > 0 ? std::min<double>(value, 1) : 0;
  return static_cast<T>(std::floor(clipped * kMax + 0.5));
}

Result<void> CheckShape(const fs::path& path, int width, int height) {
  if (width > 0 && height > 0) return {};
  return OutputError(fmt::format("{}: a picture of {} x {} pixels cannot be written", path.string(),
                                 width, height));
}

template <class T>
Result<void> WriteDisplayValues(const fs::path& path, ImageFormat format,
                                ImageView<const float> pixels, const ImageMetadata& metadata,
                                const std::function<bool()>& is_interrupted) {
  OIIO::ImageSpec spec =
      SpecOf(format, pixels.width, pixels.height, pixels.channels, OIIO::BaseTypeFromC<T>::value);
  spec.attribute("oiio:ColorSpace", "sRGB");
  AddMetadata(spec, format, metadata);
  return Encode(path, format, spec, Packing<T>(pixels, IntegerOf<T>), is_interrupted);
}

template <class T>
Result<void> WriteStored(const fs::path& path, ImageView<const T> pixels, PixelType type) {
  LF_ASSIGN_OR_RETURN(const ImageFormat format, FormatOf(path));
  LF_RETURN_IF_ERROR(CheckHolds(path, format, type, pixels.channels));
  LF_RETURN_IF_ERROR(CheckShape(path, pixels.width, pixels.height));
  const OIIO::ImageSpec spec =
      SpecOf(format, pixels.width, pixels.height, pixels.channels, OIIO::BaseTypeFromC<T>::value);
  return Encode(path, format, spec, Packing<T>(pixels, [](T v) { return v; }), {});
}

Result<void> WriteFloatTiff(const fs::path& path, ImageView<const float> pixels,
                            const ImageMetadata& metadata,
                            const std::function<bool()>& is_interrupted) {
  OIIO::ImageSpec spec = SpecOf(ImageFormat::kTiff, pixels.width, pixels.height, pixels.channels,
                                OIIO::TypeDesc::FLOAT);
  AddMetadata(spec, ImageFormat::kTiff, metadata);
  return Encode(path, ImageFormat::kTiff, spec, Packing<float>(pixels, [](float v) { return v; }),
                is_interrupted);
}

OIIO::TypeDesc TypeOf(const ExrChannel& channel) {
  if (std::holds_alternative<ImageView<const uint32_t>>(channel.pixels))
    return OIIO::TypeDesc::UINT32;
  return channel.as_half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
}

// Stores row y of a channel, with `step` bytes from pixel to pixel.
void StoreRow(const ExrChannel& channel, int y, std::byte* to, size_t step) {
  const auto copy = [&](const auto& view) {
    for (int x = 0; x < view.width; ++x) {
      const auto& value = view.at(x, y, channel.channel);
      std::memcpy(to + step * static_cast<size_t>(x), &value, sizeof(value));
    }
  };
  const auto* floats = std::get_if<ImageView<const float>>(&channel.pixels);
  if (floats != nullptr && channel.as_half)
    StoreHalves(&floats->at(0, y, channel.channel), floats->channels, floats->width, to, step);
  else
    std::visit(copy, channel.pixels);
}

}  // namespace

Result<void> WriteImage(const fs::path& path, ImageView<const float> pixels,
                        const std::vector<std::string>& channel_names, PixelType type,
                        const ImageMetadata& metadata,
                        const std::function<bool()>& is_interrupted) {
  LF_CHECK(channel_names.size() == static_cast<size_t>(pixels.channels));
  LF_ASSIGN_OR_RETURN(const ImageFormat format, FormatOf(path));
  LF_RETURN_IF_ERROR(CheckHolds(path, format, type, pixels.channels));
  LF_RETURN_IF_ERROR(CheckShape(path, pixels.width, pixels.height));
  if (type == PixelType::kUint8)
    return WriteDisplayValues<uint8_t>(path, format, pixels, metadata, is_interrupted);
  if (type == PixelType::kUint16)
    return WriteDisplayValues<uint16_t>(path, format, pixels, metadata, is_interrupted);
  if (format == ImageFormat::kTiff) return WriteFloatTiff(path, pixels, metadata, is_interrupted);
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

Result<void> WriteExr(const fs::path& path, std::span<const ExrChannel> channels,
                      const ImageMetadata& metadata, const std::function<bool()>& is_interrupted) {
  LF_CHECK(!channels.empty());
  if (LowerCaseExtension(path) != ".exr")
    return OutputError(fmt::format("{}: an EXR file needs the extension .exr", path.string()));
  const auto size = [](const ExrChannel& channel) {
    return std::visit([](const auto& view) { return std::pair(view.width, view.height); },
                      channel.pixels);
  };
  const auto [width, height] = size(channels[0]);
  LF_RETURN_IF_ERROR(CheckShape(path, width, height));
  OIIO::ImageSpec spec = SpecOf(ImageFormat::kExr, width, height, static_cast<int>(channels.size()),
                                OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const ExrChannel& channel : channels) {
    LF_CHECK(size(channel) == std::pair(width, height));
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(TypeOf(channel));
  }
  AddMetadata(spec, ImageFormat::kExr, metadata);
  const auto pack_row = [&](int y, std::byte* to) {
    for (size_t i = 0; i < channels.size(); ++i) {
      StoreRow(channels[i], y, to, spec.pixel_bytes(true));
      to += spec.channelformats[i].size();
    }
  };
  return Encode(path, ImageFormat::kExr, spec, pack_row, is_interrupted);
}

}  // namespace lf
