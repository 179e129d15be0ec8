#include "lf/imageio/raw_mosaic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "lf/imageio/tiff_directories.h"

namespace lf {
namespace {

// TIFF 6, TIFF/EP and DNG 1.4.
enum Tag {
  kNewSubfileType = 254,
  kImageWidth = 256,
  kImageLength = 257,
  kBitsPerSample = 258,
  kCompression = 259,
  kPhotometric = 262,
  kStripOffsets = 273,
  kSamplesPerPixel = 277,
  kStripByteCounts = 279,
  kTileOffsets = 324,
  kTileByteCounts = 325,
  kSampleFormat = 339,
  kCfaRepeatPatternDim = 33421,
  kCfaPattern = 33422,
  kDngVersion = 50706,
  kCfaPlaneColor = 50710,
  kCfaLayout = 50711,
  kBlackLevel = 50714,
  kWhiteLevel = 50717,
  kActiveArea = 50829
};
constexpr int kMosaic = 32803, kLinearRaw = 34892;  // of kPhotometric
constexpr const char* kAdvice =
    "convert it to DNG (uncompressed, with the mosaic), or to 16-bit TIFF or PNG without "
    "demosaicking";

bool IsThumbnail(const TiffDirectory& directory) {
  return std::fmod(directory.Number(kNewSubfileType, 0), 2) == 1;
}

double PixelCount(const TiffDirectory& directory) {
  return directory.Number(kImageWidth, 0) * directory.Number(kImageLength, 0);
}

// The largest mosaic: some cameras store a small one beside it.
Result<TiffDirectory> FindMosaic(const ByteSource& source, const std::string& name) {
  const std::vector<TiffDirectory> directories = AllTiffDirectories(source);
  const TiffDirectory* mosaic = nullptr;
  bool is_linear = false;
  for (const TiffDirectory& directory : directories) {
    const double photometric = directory.Number(kPhotometric, -1);
    is_linear |= photometric == kLinearRaw;
    if (photometric != kMosaic || IsThumbnail(directory)) continue;
    if (!mosaic || PixelCount(directory) > PixelCount(*mosaic)) mosaic = &directory;
  }
  if (mosaic) return *mosaic;
  if (is_linear)
    return InputError(
        fmt::format("{}: is a linear DNG, without a mosaic (its colours are already interpolated), "
                    "which is not read; convert it to 16-bit TIFF",
                    name));
  return InputError(fmt::format(
      "{}: is a camera raw file that does not state its mosaic in TIFF tags; {}", name, kAdvice));
}

// kNone for what is not two greens on a diagonal with red and blue.
BayerPattern PatternOf(const TiffDirectory& mosaic) {
  std::vector<double> planes = mosaic.Numbers(kCfaPlaneColor, 4);
  if (planes.empty()) planes = {0, 1, 2};
  const std::vector<double> colours = mosaic.Numbers(kCfaPattern, 4);
  if (planes != std::vector<double>{0, 1, 2} || colours.size() != 4) return BayerPattern::kNone;
  for (const BayerPattern pattern :
       {BayerPattern::kRggb, BayerPattern::kBggr, BayerPattern::kGrbg, BayerPattern::kGbrg}) {
    bool same = true;
    for (int i = 0; i < 4; ++i) same &= BayerChannel(pattern, i % 2, i / 2) == colours[i];
    if (same) return pattern;
  }
  return BayerPattern::kNone;
}

Result<void> CheckMosaic(const TiffDirectory& mosaic, const std::string& name) {
  const std::vector<double> repeat = mosaic.Numbers(kCfaRepeatPatternDim, 2);
  if (repeat.size() == 2 && repeat != std::vector<double>{2, 2})
    return InputError(
        fmt::format("{}: its colour filter repeats every {} x {} pixels; only Bayer mosaics, which "
                    "repeat every 2 x 2, are read (X-Trans and others: demosaic first)",
                    name, repeat[1], repeat[0]));
  if (mosaic.Number(kCfaLayout, 1) != 1)
    return InputError(
        fmt::format("{}: the pixels of its mosaic are staggered (CFALayout {}), not in rows and "
                    "columns: not read",
                    name, mosaic.Number(kCfaLayout, 1)));
  const double samples = mosaic.Number(kSamplesPerPixel, 1);
  const double format = mosaic.Number(kSampleFormat, 1), bits = mosaic.Number(kBitsPerSample, 0);
  if (samples != 1 || format != 1 || !(bits >= 8 && bits <= 16))
    return InputError(fmt::format(
        "{}: its mosaic has {} channels of {} bits{}: expected one of 8 to 16 bits, integers; {}",
        name, samples, bits, format == 1 ? "" : " (floating point)", kAdvice));
  return {};
}

// The size of a file, as far as `source` tells: whether there is a byte before `end`.
bool Reaches(const ByteSource& source, double end) {
  std::array<uint8_t, 1> byte;
  if (!(end >= 0 && end < 1e18)) return false;
  return end == 0 || source(static_cast<uint64_t>(end) - 1, byte) == 1;
}

// LibRaw allocates by width and height, and fills what a short file lacks.
Result<void> CheckPixelBytes(const ByteSource& source, const TiffDirectory& mosaic,
                             const std::string& name) {
  const double width = mosaic.Number(kImageWidth, 0), height = mosaic.Number(kImageLength, 0);
  if (!(width >= 1 && height >= 1 && width < 4294967296.0 && height < 4294967296.0))
    return InputError(fmt::format("{}: claims {} x {} pixels", name, width, height));
  LF_RETURN_IF_ERROR(
      CheckPixelCount(static_cast<uint64_t>(width), static_cast<uint64_t>(height), name));
  constexpr size_t kMaxPartCount = size_t{1} << 20;
  const bool tiled = mosaic.Has(kTileOffsets);
  const auto offsets = mosaic.Numbers(tiled ? kTileOffsets : kStripOffsets, kMaxPartCount);
  const auto sizes = mosaic.Numbers(tiled ? kTileByteCounts : kStripByteCounts, kMaxPartCount);
  if (offsets.empty() || offsets.size() != sizes.size())
    return InputError(
        fmt::format("{}: does not say where its pixels are: truncated or damaged", name));
  for (size_t i = 0; i < offsets.size(); ++i)
    if (!Reaches(source, offsets[i] + sizes[i]))
      return InputError(fmt::format("{}: ends before its pixels do: truncated or damaged", name));
  // A code of a compressed pixel has at least one bit; runs of equal ones may share it.
  constexpr double kMostPixelsPerByte = 512;
  const bool is_packed = mosaic.Number(kCompression, 1) == 1;
  const double least_bytes = is_packed ? width * height * mosaic.Number(kBitsPerSample, 0) / 8
                                       : width * height / kMostPixelsPerByte;
  if (std::accumulate(sizes.begin(), sizes.end(), 0.0) < std::floor(least_bytes))
    return InputError(
        fmt::format("{}: claims {} x {} pixels, for which the file is too short: truncated or "
                    "damaged",
                    name, width, height));
  return {};
}

// The active area [top, left, bottom, right], where a DNG states it.
Result<void> ReadSize(const TiffDirectory& mosaic, const std::string& name, RawMosaic* raw) {
  const double width = mosaic.Number(kImageWidth, 0), height = mosaic.Number(kImageLength, 0);
  std::vector<double> area = mosaic.Numbers(kActiveArea, 4);
  if (area.size() != 4) area = {0, 0, height, width};
  if (!(area[0] >= 0 && area[1] >= 0 && area[0] < area[2] && area[1] < area[3] &&
        area[2] <= height && area[3] <= width))
    return InputError(
        fmt::format("{}: its active area, {} to {} in x and {} to {} in y, is no part of its {} x "
                    "{} pixels: damaged",
                    name, area[1], area[3], area[0], area[2], width, height));
  raw->width = static_cast<int>(area[3] - area[1]);
  raw->height = static_cast<int>(area[2] - area[0]);
  return {};
}

void ReadLevels(const TiffDirectory& mosaic, bool is_dng, RawMosaic* raw) {
  const auto is_level = [](double x) { return x >= 0 && x <= 65535; };
  const std::vector<double> black = mosaic.Numbers(kBlackLevel, 64);
  if (!black.empty() && std::all_of(black.begin(), black.end(), is_level))
    raw->black_level =
        std::accumulate(black.begin(), black.end(), 0.0) / static_cast<double>(black.size());
  else if (is_dng && !mosaic.Has(kBlackLevel))
    raw->black_level = 0;  // DNG's default
  const double largest = std::exp2(mosaic.Number(kBitsPerSample, 16)) - 1;
  const double white = mosaic.Number(kWhiteLevel, is_dng ? largest : -1);
  if (is_level(white) && white > raw->black_level.value_or(0)) raw->white_level = white;
}

}  // namespace

bool IsRawTiff(const ByteSource& source) {
  std::array<uint8_t, 10> head{};
  if (source(0, head) == head.size() && head[8] == 'C' && head[9] == 'R') return true;  // CR2
  const std::optional<TiffDirectory> first = FirstTiffDirectory(source);
  return first && (first->Has(kDngVersion) || IsThumbnail(*first));
}

Result<RawMosaic> ReadRawMosaic(const ByteSource& source, const std::string& name) {
  LF_ASSIGN_OR_RETURN(const TiffDirectory mosaic, FindMosaic(source, name));
  LF_RETURN_IF_ERROR(CheckMosaic(mosaic, name));
  LF_RETURN_IF_ERROR(CheckPixelBytes(source, mosaic, name));
  RawMosaic raw;
  LF_RETURN_IF_ERROR(ReadSize(mosaic, name, &raw));
  raw.bayer = PatternOf(mosaic);
  const std::optional<TiffDirectory> first = FirstTiffDirectory(source);
  ReadLevels(mosaic, first && first->Has(kDngVersion), &raw);
  return raw;
}

}  // namespace lf
