// SPDX-License-Identifier: Apache-2.0
// Reads the first directory and the Exif data of a TIFF or BigTIFF file without a decoder. The
// first directory tells whether the file is a camera raw file. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "lf/pixels/files/image_probe.h"

namespace lf {

// One directory (IFD): its tags, and the positions of their values. Only the first 1024 tags of a
// directory are read.
class TiffDirectory {
 public:
  bool Has(int tag) const { return entries_.contains(tag); }
  // Returns the values of a tag as numbers (a fraction as its quotient). Empty if the tag is
  // missing, is not a number, has more than `limit` values or lies beyond the end of the file.
  std::vector<double> Numbers(int tag, size_t limit) const;
  // Returns the first value of a tag, or `otherwise` if Numbers(tag, 16) is empty.
  double Number(int tag, double otherwise) const;

 private:
  friend class TiffReader;
  struct Entry {
    int type = 0;
    uint64_t count = 0;
    uint64_t offset = 0;  // position of the first value in the file
  };
  const ByteSource* source_ = nullptr;
  bool little_endian_ = true;
  std::map<int, Entry> entries_;
};

// Returns the first directory. Returns none if it cannot be read or has no tags. `source` must
// outlive the directory.
std::optional<TiffDirectory> FirstTiffDirectory(const ByteSource& source);

// Returns the directory of Exif data that the first directory points to; none if it points to none,
// or if one of the two directories cannot be read.
std::optional<TiffDirectory> ExifDirectory(const ByteSource& source);

}  // namespace lf
