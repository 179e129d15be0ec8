// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/image_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "lf/pixels/files/big_endian.h"
#include "lf/pixels/files/tiff_directories.h"

namespace lf {
namespace {

bool StartsWith(std::span<const uint8_t> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

// Refuses a header that claims more than the file can hold, before a decoder believes it. A whole
// file with a picture of this size has at least least_bytes.
Result<void> CheckClaim(const ByteSource& source, uint64_t width, uint64_t height,
                        uint64_t least_bytes, const std::string& name) {
  LF_RETURN_IF_ERROR(CheckPixelCount(width, height, name));
  if (least_bytes == 0 || BigEndian(source, least_bytes - 1, 1)) return {};
  return InputError(
      fmt::format("{}: claims {} x {} pixels, for which the file is too short: "
                  "truncated or damaged",
                  name, width, height));
}

constexpr uint64_t kPngPixels = 0x49444154, kPngEnd = 0x49454e44;  // "IDAT", "IEND"

// A chunk of a PNG file, which consists of length, type, content and checksum.
struct PngChunk {
  uint64_t type = 0;
  uint64_t end = 0;       // offset behind the chunk
  bool is_whole = false;  // true if the file does not end within the chunk
};

// Returns the chunk that begins at `offset`; none if the file ends before its content.
std::optional<PngChunk> PngChunkAt(const ByteSource& source, uint64_t offset) {
  const auto length = BigEndian(source, offset, 4), type = BigEndian(source, offset + 4, 4);
  if (!length || !type) return std::nullopt;
  const uint64_t end = offset + 12 + *length;
  return PngChunk{*type, end, BigEndian(source, end - 1, 1).has_value()};
}
constexpr uint64_t kFirstPngChunk = 8;

// Checks the chunks before the pixels, because libpng allocates as many bytes as such a chunk
// claims.
Result<void> CheckPngChunks(const ByteSource& source, const std::string& name) {
  uint64_t offset = kFirstPngChunk;
  while (const auto chunk = PngChunkAt(source, offset)) {
    if (chunk->type == kPngPixels || chunk->type == kPngEnd) break;
    if (!chunk->is_whole)
      return InputError(
          fmt::format("{}: claims a PNG chunk of {} bytes, for which the file is too short: "
                      "truncated or damaged",
                      name, chunk->end - offset - 12));
    offset = chunk->end;
  }
  return {};
}

Result<void> CheckPng(const ByteSource& source, const std::string& name) {
  const auto width = BigEndian(source, 16, 4), height = BigEndian(source, 20, 4);
  const auto depth = BigEndian(source, 24, 1), colour_type = BigEndian(source, 25, 1);
  if (!width || !height || !depth || !colour_type)
    return InputError(fmt::format("{}: PNG file ends within its header", name));
  constexpr uint64_t kDeflateRatio = 1032;  // largest compression ratio of deflate
  const uint64_t channels = *colour_type == 2   ? 3
                            : *colour_type == 4 ? 2
                            : *colour_type == 6 ? 4
                                                : 1;
  const uint64_t row_bytes = *width * channels * *depth / 8;
  LF_RETURN_IF_ERROR(
      CheckClaim(source, *width, *height, *height * row_bytes / kDeflateRatio, name));
  return CheckPngChunks(source, name);
}

// Checks the size in the frame header (SOFn). Skips bytes between segments, as libjpeg does.
Result<void> CheckJpeg(const ByteSource& source, const std::string& name) {
  uint64_t offset = 2;
  while (const auto byte = BigEndian(source, offset++, 1)) {
    if (*byte != 0xff) continue;
    std::optional<uint64_t> marker;
    while ((marker = BigEndian(source, offset++, 1)) == 0xff) continue;
    if (!marker || *marker == 0xd9 || *marker == 0xda) break;
    // These markers have no content.
    if (*marker <= 0x01 || (*marker >= 0xd0 && *marker <= 0xd8)) continue;
    const bool is_frame =
        *marker >= 0xc0 && *marker <= 0xcf && *marker != 0xc4 && *marker != 0xc8 && *marker != 0xcc;
    if (is_frame) {
      const auto height = BigEndian(source, offset + 3, 2),
                 width = BigEndian(source, offset + 5, 2);
      if (!width || !height) break;
      // A Huffman code has at least one bit, and there is at least one code for every 8 x 8 pixels.
      const bool is_huffman = *marker < 0xc8;
      return CheckClaim(source, *width, *height, is_huffman ? *width * *height / 512 : 0, name);
    }
    const auto length = BigEndian(source, offset, 2);
    if (!length) break;
    offset += std::max<uint64_t>(*length, 2);
  }
  return InputError(
      fmt::format("{}: JPEG file without a frame header, which states the size of the picture: "
                  "truncated or damaged",
                  name));
}

// Returns true for the first bytes of a camera raw file that is not a TIFF file.
bool IsOtherRaw(std::span<const uint8_t> start) {
  using namespace std::string_view_literals;
  struct Kind {
    size_t offset;
    std::string_view magic;
  };
  // Fujifilm RAF, Sigma X3F, Olympus ORF, Panasonic RW2, Minolta MRW, Canon CR3 and CRW.
  constexpr Kind kKinds[] = {{0, "FUJIFILM"sv}, {0, "FOVb"sv},     {0, "IIRO"sv},
                             {0, "IIRS"sv},     {0, "MMOR"sv},     {0, "IIU\0"sv},
                             {0, "\0MRM"sv},    {4, "ftypcrx "sv}, {6, "HEAPCCDR"sv}};
  for (const Kind& kind : kKinds)
    if (start.size() >= kind.offset && StartsWith(start.subspan(kind.offset), kind.magic))
      return true;
  return false;
}

// A format, and the bytes that its files have at an offset.
template <class Format>
struct Signature {
  size_t offset;
  std::string_view magic;
  Format format;
};

template <class Format, size_t N>
std::optional<Format> FormatBySignature(std::span<const uint8_t> start,
                                        const Signature<Format> (&signatures)[N]) {
  for (const Signature<Format>& signature : signatures)
    if (start.size() >= signature.offset &&
        StartsWith(start.subspan(signature.offset), signature.magic))
      return signature.format;
  return std::nullopt;
}

// Returns the format of a file that is read by its first bytes alone.
std::optional<ImageFormat> SimpleFormat(std::span<const uint8_t> start) {
  using namespace std::string_view_literals;
  // The magic numbers of Netpbm are followed by a blank.
  if (start.size() >= 3 && start[0] == 'P' && std::isspace(start[2]) != 0) {
    if (start[1] >= '1' && start[1] <= '7') return ImageFormat::kNetpbm;
    if (start[1] == 'f' || start[1] == 'F') return ImageFormat::kPfm;
  }
  if (StartsWith(start, "RIFF") && start.size() >= 12 && StartsWith(start.subspan(8), "WEBP"))
    return ImageFormat::kWebp;
  // BMP: the two reserved numbers at byte 6 are 0, which tells it from a text that begins with
  // "BM".
  if (StartsWith(start, "BM") && start.size() >= 10 && StartsWith(start.subspan(6), "\0\0\0\0"sv))
    return ImageFormat::kBmp;
  constexpr Signature<ImageFormat> kSignatures[] = {
      {0, "\x76\x2f\x31\x01"sv, ImageFormat::kExr},
      {0, "#?RADIANCE"sv, ImageFormat::kRadiance},
      {0, "#?RGBE"sv, ImageFormat::kRadiance},
      {0, "\0\0\0\x0cjP  \r\n\x87\n"sv, ImageFormat::kJpeg2000},
      {0, "\xff\x4f\xff\x51"sv, ImageFormat::kJpeg2000},
      {0, "\0\0\0\x0cJXL \r\n\x87\n"sv, ImageFormat::kJpegXl},
      {0, "\xff\x0a"sv, ImageFormat::kJpegXl},
      {4, "ftyphei"sv, ImageFormat::kHeif},
      {4, "ftyphev"sv, ImageFormat::kHeif},
      {4, "ftypmif1"sv, ImageFormat::kHeif},
      {4, "ftypmsf1"sv, ImageFormat::kHeif},
      {4, "ftypavif"sv, ImageFormat::kHeif},
      {4, "ftypavis"sv, ImageFormat::kHeif},
  };
  return FormatBySignature(start, kSignatures);
}

// Returns the name of a format that is not read, with a hint; "" for unknown bytes.
std::string_view NameOfForeign(std::span<const uint8_t> start) {
  using namespace std::string_view_literals;
  constexpr auto kVideo =
      "a video: extract its pictures, for instance by ffmpeg, and give their folder"sv;
  constexpr Signature<std::string_view> kSignatures[] = {
      {0, "GIF8"sv, "a GIF file: convert it to PNG"sv},
      {0, "8BPS"sv, "a Photoshop file (PSD): save it as PNG or TIFF"sv},
      {0, "SDPX"sv, "a DPX file: convert it to TIFF or EXR"sv},
      {0, "XPDS"sv, "a DPX file: convert it to TIFF or EXR"sv},
      {0, "DDS "sv, "a DirectDraw surface (DDS): convert it to PNG"sv},
      {0, "\0\0\1\0"sv, "an icon (ICO): convert it to PNG"sv},
      {0, "II\xbc\x01"sv, "a JPEG XR file: convert it to TIFF"sv},
      {0, "gimp xcf"sv, "a file of GIMP (XCF): export it as PNG"sv},
      {0, "%PDF"sv, "a PDF document: convert its pages to PNG"sv},
      {0, "<svg"sv, "an SVG drawing: convert it to PNG"sv},
      {0, "\x89LFP\r\n\x1a\n"sv,
       "a picture of a Lytro camera: decode it with plenopticam or LFToolbox, which write a folder "
       "of views"sv},
      {0, "\x89HDF\r\n\x1a\n"sv, "an HDF5 file: give it as LIGHTFIELD if it holds views"sv},
      {0, "\x93NUMPY"sv, "a NumPy file: give it as LIGHTFIELD if it holds views"sv},
      {4, "ftyp"sv, kVideo},
      {4, "moov"sv, kVideo},
      {0, "\x1a\x45\xdf\xa3"sv, kVideo},
      {8, "AVI "sv, kVideo},
      {0, "PK\3\4"sv, "a ZIP archive: unpack it"sv},
      {0, "\x1f\x8b"sv, "a gzip archive: unpack it"sv},
      {0, "version https://git-lfs"sv,
       "a pointer of Git LFS instead of the picture: fetch it by git lfs pull"sv},
      {0, "<!DOCTYPE"sv, "a web page instead of a picture: download the picture again"sv},
      {0, "<html"sv, "a web page instead of a picture: download the picture again"sv},
  };
  return FormatBySignature(start, kSignatures).value_or("");
}

// Returns true if a TIFF file is a camera raw file.
bool IsRawTiff(const ByteSource& source, std::span<const uint8_t> start) {
  constexpr int kNewSubfileType = 254, kDngVersion = 50706;
  if (start.size() >= 10 && start[8] == 'C' && start[9] == 'R') return true;  // Canon CR2
  const std::optional<TiffDirectory> first = FirstTiffDirectory(source);
  return first && (first->Has(kDngVersion) || std::fmod(first->Number(kNewSubfileType, 0), 2) == 1);
}

}  // namespace

const char* NameOf(ImageFormat format) {
  constexpr const char* kNames[] = {"PNG",       "JPEG",    "TIFF", "EXR",      "raw",
                                    "Netpbm",    "PFM",     "BMP",  "Radiance", "WebP",
                                    "JPEG 2000", "JPEG XL", "HEIF"};
  return kNames[static_cast<int>(format)];
}

Result<void> CheckPixelCount(uint64_t width, uint64_t height, const std::string& name) {
  // Width and height are below 2^32, so the product does not wrap.
  if (width * height <= kMaxImagePixels) return {};
  return InputError(
      fmt::format("{}: claims {} x {} pixels, more than the limit of {} pixels in total", name,
                  width, height, kMaxImagePixels));
}

Result<ImageFormat> ProbeImage(const ByteSource& source, const std::string& name) {
  std::array<uint8_t, 32> head;
  const auto start = std::span<const uint8_t>(head).first(source(0, head));
  if (start.empty()) return InputError(fmt::format("{}: file is empty", name));
  if (StartsWith(start, "\x89PNG\r\n\x1a\n")) {
    LF_RETURN_IF_ERROR(CheckPng(source, name));
    return ImageFormat::kPng;
  }
  if (StartsWith(start, "\xff\xd8\xff")) {
    LF_RETURN_IF_ERROR(CheckJpeg(source, name));
    return ImageFormat::kJpeg;
  }
  if (const std::optional<ImageFormat> format = SimpleFormat(start)) return *format;
  using namespace std::string_view_literals;
  for (const std::string_view tiff : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (!StartsWith(start, tiff)) continue;
    return IsRawTiff(source, start) ? ImageFormat::kRaw : ImageFormat::kTiff;
  }
  if (IsOtherRaw(start)) return ImageFormat::kRaw;
  if (const std::string_view foreign = NameOfForeign(start); !foreign.empty())
    return InputError(fmt::format("{}: is not a PNG, JPEG or other image file that is read, but {}",
                                  name, foreign));
  return InputError(fmt::format(
      "{}: is not a PNG, JPEG, TIFF, EXR, WebP, JPEG XL, HEIF, JPEG 2000, BMP, PPM, PFM, "
      "HDR or supported camera raw file: convert it to PNG or TIFF",
      name));
}

Result<void> CheckPngIsComplete(const ByteSource& source, const std::string& name) {
  uint64_t offset = kFirstPngChunk;
  while (const auto chunk = PngChunkAt(source, offset)) {
    if (!chunk->is_whole) break;
    if (chunk->type == kPngEnd) return {};
    offset = chunk->end;
  }
  return InputError(fmt::format("{}: PNG file is truncated: it ends before its end mark", name));
}

}  // namespace lf
