// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/exif_orientation.h"

#include <algorithm>
#include <array>
#include <optional>

#include "lf/pixels/files/file_bytes.h"
#include "lf/pixels/files/tiff_directories.h"

namespace lf {

int OrientationOfTiff(std::span<const uint8_t> tiff) {
  const FileBytes file =
      FileInMemory({reinterpret_cast<const char*>(tiff.data()), tiff.size()}, "Exif data");
  const std::optional<TiffDirectory> directory = FirstTiffDirectory(file.read);
  constexpr int kOrientationTag = 0x112;
  const double orientation = directory ? directory->Number(kOrientationTag, 1) : 1;
  return orientation >= 1 && orientation <= 8 ? static_cast<int>(orientation) : 1;
}

int OrientationOfExif(std::span<const uint8_t> segment) {
  constexpr std::array<uint8_t, 6> kExif = {'E', 'x', 'i', 'f', 0, 0};
  if (segment.size() < kExif.size() || !std::equal(kExif.begin(), kExif.end(), segment.begin()))
    return 1;
  return OrientationOfTiff(segment.subspan(kExif.size()));
}

}  // namespace lf
