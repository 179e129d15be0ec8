// The first directory of a TIFF file, read without a decoder: whether it is a camera raw file, and
// what Exif data say. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "lf/imageio/image_probe.h"

namespace lf {

// One directory (IFD): its tags, and where their values are. It has 1024 tags at most.
class TiffDirectory {
 public:
  bool Has(int tag) const { return entries_.contains(tag); }
  // The values of a tag as numbers (fractions divided). Empty where it is missing, is no number,
  // holds more than `limit` values or lies beyond the end of the file.
  std::vector<double> Numbers(int tag, size_t limit) const;
  // The first value of a tag; where there is none, the default.
  double Number(int tag, double otherwise) const;

 private:
  friend class TiffReader;
  struct Entry {
    int type = 0;
    uint64_t count = 0;
    uint64_t offset = 0;  // in the file
  };
  const ByteSource* source_ = nullptr;
  bool little_endian_ = true;
  std::map<int, Entry> entries_;
};

// The first directory; none in BigTIFF files, which no camera writes. `source` must outlive it.
std::optional<TiffDirectory> FirstTiffDirectory(const ByteSource& source);

// The directory of Exif data that the first one names; none as above.
std::optional<TiffDirectory> ExifDirectory(const ByteSource& source);

}  // namespace lf
