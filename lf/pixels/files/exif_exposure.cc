// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/exif_exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "lf/pixels/files/big_endian.h"
#include "lf/pixels/files/tiff_directories.h"

namespace lf {
namespace {

// Values outside [kLeast, kMost], such as an f-number of 0, mean "not known".
constexpr double kLeast = 1e-12, kMost = 1e12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::optional<double> IfStated(double value) {
  return value >= kLeast && value <= kMost ? std::optional(value) : std::nullopt;
}

ExposureFacts FactsOf(const TiffDirectory& exif) {
  constexpr int kExposureTime = 0x829A, kFNumber = 0x829D, kSensitivity = 0x8827;
  constexpr int kRecommendedIndex = 0x8832, kIsoSpeed = 0x8833;
  constexpr int kShutterSpeedValue = 0x9201, kApertureValue = 0x9202;
  // Largest value of the sensitivity tag, which has 16 bits. A larger sensitivity is stated in
  // other tags (Exif 2.3, 4.6.5).
  constexpr double kMostSensitivity = 65535;
  ExposureFacts facts;
  facts.time_s = IfStated(exif.Number(kExposureTime, 0));
  if (!facts.time_s) facts.time_s = IfStated(std::exp2(-exif.Number(kShutterSpeedValue, kNone)));
  facts.f_number = IfStated(exif.Number(kFNumber, 0));
  if (!facts.f_number) facts.f_number = IfStated(std::exp2(exif.Number(kApertureValue, kNone) / 2));
  facts.iso = IfStated(exif.Number(kSensitivity, 0));
  for (const int tag : {kRecommendedIndex, kIsoSpeed})
    if (!facts.iso || *facts.iso >= kMostSensitivity)
      if (const std::optional<double> stated = IfStated(exif.Number(tag, 0))) facts.iso = stated;
  return facts;
}

// Returns a source of the bytes [begin, end) of `source`.
ByteSource PartOf(const ByteSource& source, uint64_t begin, uint64_t end) {
  return [&source, begin, end](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= end - begin) return 0;
    return source(begin + offset, to.first(std::min<uint64_t>(to.size(), end - begin - offset)));
  };
}

ExposureFacts FactsOfTiff(const ByteSource& source) {
  const std::optional<TiffDirectory> exif = ExifDirectory(source);
  return exif ? FactsOf(*exif) : ExposureFacts();
}

// Reads the Exif data, which are in an APP1 segment before the pixels.
ExposureFacts FactsOfJpeg(const ByteSource& source) {
  constexpr uint64_t kExif = 0x457869660000, kApp1 = 0xe1, kStartOfScan = 0xda;
  uint64_t offset = 2;
  while (const auto byte = BigEndian(source, offset++, 1)) {
    if (*byte != 0xff) continue;
    std::optional<uint64_t> marker;
    while ((marker = BigEndian(source, offset++, 1)) == 0xff) continue;
    if (!marker || *marker == kStartOfScan) break;
    // These markers have no content.
    if (*marker <= 0x01 || (*marker >= 0xd0 && *marker <= 0xd9)) continue;
    const auto length = BigEndian(source, offset, 2);
    if (!length) break;
    const uint64_t end = offset + std::max<uint64_t>(*length, 2);
    if (marker == kApp1 && end > offset + 8 && BigEndian(source, offset + 2, 6) == kExif)
      return FactsOfTiff(PartOf(source, offset + 8, end));
    offset = end;
  }
  return {};
}

// Reads the Exif data, which are in the chunk eXIf (PNG, third edition, 11.3.4.5).
ExposureFacts FactsOfPng(const ByteSource& source) {
  constexpr uint64_t kExif = 0x65584966;
  uint64_t offset = 8;  // position of a chunk: length, type, content, checksum
  while (true) {
    const auto length = BigEndian(source, offset, 4), type = BigEndian(source, offset + 4, 4);
    if (!length || !type) return {};
    if (type == kExif) return FactsOfTiff(PartOf(source, offset + 8, offset + 8 + *length));
    offset += 12 + *length;
  }
}

}  // namespace

ExposureFacts ExposureOfExif(const ByteSource& source, ImageFormat format) {
  switch (format) {
    case ImageFormat::kJpeg:
      return FactsOfJpeg(source);
    case ImageFormat::kTiff:
      return FactsOfTiff(source);
    case ImageFormat::kPng:
      return FactsOfPng(source);
    default:
      return {};
  }
}

}  // namespace lf
