// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/tiff_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/picture_decoder.h"

namespace lf {
namespace {

// Returns the value of a tag of 16 bits: libtiff's default if the file lacks the tag, `otherwise`
// if the tag has no default.
uint16_t Value(TIFF* tiff, uint32_t tag, uint16_t otherwise) {
  uint16_t value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : otherwise;
}

uint32_t WideValue(TIFF* tiff, uint32_t tag, uint32_t otherwise) {
  uint32_t value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : otherwise;
}

// Returns the photometric interpretation. Its tag has no default: a picture without it counts as
// grey if it has one sample per pixel, otherwise as RGB.
uint16_t PhotometricOf(TIFF* tiff, int samples) {
  uint16_t value = samples == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &value);
  return value;
}

Error NotRead(const std::string& name, const std::string& kind, const std::string& remedy) {
  return InputError(fmt::format(
      "{}: is a TIFF file with {}, which is not supported: convert it to {}", name, kind, remedy));
}

Result<void> CheckColours(uint16_t photometric, int compression, bool is_separate,
                          const std::string& name) {
  const char* kind = nullptr;
  if (photometric == PHOTOMETRIC_SEPARATED) kind = "CMYK or other ink colours";
  if (photometric == PHOTOMETRIC_CIELAB || photometric == PHOTOMETRIC_ICCLAB ||
      photometric == PHOTOMETRIC_ITULAB)
    kind = "CIE L*a*b* colours";
  if (photometric == PHOTOMETRIC_LOGL || photometric == PHOTOMETRIC_LOGLUV) kind = "LogLuv colours";
  if (photometric == PHOTOMETRIC_YCBCR && (compression != COMPRESSION_JPEG || is_separate))
    kind = "YCbCr colours that are not compressed as JPEG";
  if (kind != nullptr) return NotRead(name, kind, "RGB");
  if (compression == COMPRESSION_OJPEG)
    return NotRead(name, "the old kind of JPEG compression", "a TIFF file without JPEG");
  if (compression != COMPRESSION_NONE &&
      TIFFIsCODECConfigured(static_cast<uint16_t>(compression)) == 0)
    return NotRead(name, fmt::format("compression {}", compression), "deflate (zip) compression");
  return {};
}

Result<TiffSamples> SamplesOf(TIFF* tiff, const std::string& name) {
  TiffSamples samples;
  samples.bits = Value(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  const uint16_t format = Value(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const char* kind = "unsigned integers";
  if (format == SAMPLEFORMAT_INT) {
    samples.kind = TiffSamples::Kind::kSigned;
    kind = "signed integers";
  } else if (format == SAMPLEFORMAT_IEEEFP) {
    samples.kind = TiffSamples::Kind::kFloat;
    kind = "floats";
  } else if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_VOID) {
    kind = "complex numbers";
  }
  const bool is_complex = format == SAMPLEFORMAT_COMPLEXINT || format == SAMPLEFORMAT_COMPLEXIEEEFP;
  if (is_complex || !CanConvert(samples))
    return NotRead(name, fmt::format("{} of {} bits", kind, samples.bits),
                   "integers of 8 or 16 bits, or floats of 32 bits");
  return samples;
}

// Returns the palette in values of 8 bits. The file has values of 16 bits.
Result<std::vector<uint8_t>> PaletteOf(TIFF* tiff, const TiffLayout& layout,
                                       const std::string& name) {
  uint16_t* colours[3] = {};
  const int bits = layout.type.bits;
  if (layout.samples != 1)
    return NotRead(name, "a palette and further channels", "RGB without a palette");
  if (layout.type.kind != TiffSamples::Kind::kUnsigned || bits > 16)
    return NotRead(name, fmt::format("a palette and {} bits", bits), "RGB without a palette");
  if (TIFFGetField(tiff, TIFFTAG_COLORMAP, &colours[0], &colours[1], &colours[2]) != 1 ||
      std::count(std::begin(colours), std::end(colours), nullptr) > 0)
    return InputError(fmt::format("{}: truncated or damaged: the palette is missing", name));
  std::vector<uint8_t> palette;
  for (size_t i = 0; i < size_t{1} << bits; ++i)
    for (const uint16_t* colour : colours) palette.push_back(static_cast<uint8_t>(colour[i] / 257));
  return palette;
}

// Returns the names R, G, B, A, channel4, ... (Y for a single channel), except that the tag about
// extra samples decides which channel is A. Without this tag the fourth channel is A.
std::vector<std::string> ChannelNames(TIFF* tiff, uint16_t photometric, const TiffLayout& layout) {
  const auto other = [](int channel) { return fmt::format("channel{}", channel); };
  const int count = layout.channels();
  std::vector<std::string> names = {"R", "G", "B", "A"};
  if (count == 1) names = {"Y"};
  names.resize(static_cast<size_t>(count));
  for (int channel = 4; channel < count; ++channel) names[channel] = other(channel);

  uint16_t extra_count = 0;
  const uint16_t* extras = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &extra_count, &extras) != 1) return names;
  const bool is_grey = photometric == PHOTOMETRIC_MINISWHITE ||
                       photometric == PHOTOMETRIC_MINISBLACK ||
                       photometric == PHOTOMETRIC_PALETTE || photometric == PHOTOMETRIC_MASK;
  int alpha = count > 3 ? 3 : -1;
  for (int i = 0, channel = is_grey ? 1 : 3; i < extra_count && channel < count; ++i, ++channel) {
    if (extras[i] == EXTRASAMPLE_ASSOCALPHA || extras[i] == EXTRASAMPLE_UNASSALPHA) {
      alpha = channel;
    } else if (channel == alpha) {
      names[channel] = other(channel);
      alpha = -1;
    }
  }
  if (alpha >= 0) names[alpha] = "A";
  if (alpha == 1 && count == 2) names[0] = "Y";
  return names;
}

// Sets the size of the blocks. kInput if tiles are much larger than the picture: libtiff decodes a
// block as a whole, so they would need much memory.
Result<void> SetBlocks(TIFF* tiff, const std::string& name, TiffLayout* layout) {
  layout->is_tiled = TIFFIsTiled(tiff) != 0;
  const auto height = static_cast<uint32_t>(layout->height);
  layout->block_width = static_cast<uint32_t>(layout->width);
  layout->block_height = std::clamp(WideValue(tiff, TIFFTAG_ROWSPERSTRIP, height), 1u, height);
  if (!layout->is_tiled) return {};
  layout->block_width = std::max(WideValue(tiff, TIFFTAG_TILEWIDTH, 0), 1u);
  layout->block_height = std::max(WideValue(tiff, TIFFTAG_TILELENGTH, 0), 1u);
  const uint64_t tile_pixels = uint64_t{layout->block_width} * layout->block_height;
  const uint64_t pixels = uint64_t{height} * static_cast<uint64_t>(layout->width);
  constexpr uint64_t kUsualTile = uint64_t{1} << 24, kMostTimesPicture = 16;
  if (tile_pixels <= std::max(kUsualTile, std::min(kMaxImagePixels, kMostTimesPicture * pixels)))
    return {};
  return InputError(
      fmt::format("{}: claims tiles of {} x {} pixels, too large for a picture of {} x {} pixels; "
                  "write the file again with smaller tiles",
                  name, layout->block_width, layout->block_height, layout->width, layout->height));
}

// Checks that libtiff expects blocks of the sizes in `layout`, because libtiff writes whole blocks
// into buffers of these sizes.
Result<void> CheckSizesAgree(TIFF* tiff, const TiffLayout& layout, const std::string& name) {
  const uint64_t block_bytes =
      layout.is_tiled ? TIFFTileSize64(tiff) : TIFFVStripSize64(tiff, layout.block_height);
  const uint32_t blocks = layout.is_tiled ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  const uint64_t own_blocks = layout.block_count();
  if (block_bytes == layout.block_bytes() && blocks == own_blocks) return {};
  return InputError(
      fmt::format("{}: truncated or damaged: it states {} tiles or strips of {} bytes, but the "
                  "picture needs {} of {} bytes",
                  name, blocks, block_bytes, own_blocks, layout.block_bytes()));
}

}  // namespace

Result<TiffLayout> TiffLayoutOf(TIFF* tiff, const std::string& name) {
  TiffLayout layout;
  layout.samples = Value(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  const int64_t width = WideValue(tiff, TIFFTAG_IMAGEWIDTH, 0);
  const int64_t height = WideValue(tiff, TIFFTAG_IMAGELENGTH, 0);
  LF_RETURN_IF_ERROR(CheckPictureSize(width, height, layout.samples, name));
  layout.width = static_cast<int>(width);
  layout.height = static_cast<int>(height);
  if (WideValue(tiff, TIFFTAG_IMAGEDEPTH, 1) > 1 || WideValue(tiff, TIFFTAG_TILEDEPTH, 1) > 1)
    return InputError(
        fmt::format("{}: is a TIFF file of a volume (several slices of depth): expected a picture; "
                    "save one slice",
                    name));

  const uint16_t photometric = PhotometricOf(tiff, layout.samples);
  layout.compression = Value(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  layout.is_separate = layout.samples > 1 && Value(tiff, TIFFTAG_PLANARCONFIG,
                                                   PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
  LF_RETURN_IF_ERROR(CheckColours(photometric, layout.compression, layout.is_separate, name));
  if (photometric == PHOTOMETRIC_YCBCR)
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);  // libjpeg converts it to RGB

  LF_ASSIGN_OR_RETURN(layout.type, SamplesOf(tiff, name));
  layout.is_inverted = photometric == PHOTOMETRIC_MINISWHITE && StoredBitsOf(layout.type) <= 16;
  if (photometric == PHOTOMETRIC_PALETTE) {
    LF_ASSIGN_OR_RETURN(layout.palette, PaletteOf(tiff, layout, name));
    LF_RETURN_IF_ERROR(CheckPictureSize(width, height, layout.channels(), name));
  }
  LF_RETURN_IF_ERROR(SetBlocks(tiff, name, &layout));
  LF_RETURN_IF_ERROR(CheckSizesAgree(tiff, layout, name));
  layout.channel_names = ChannelNames(tiff, photometric, layout);
  const uint16_t orientation = Value(tiff, TIFFTAG_ORIENTATION, 1);
  if (orientation >= 1 && orientation <= 8) layout.orientation = orientation;
  return layout;
}

}  // namespace lf
