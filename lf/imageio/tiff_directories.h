// The directories of a TIFF file, read without a decoder: what camera raw files say about
// themselves. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "lf/imageio/image_probe.h"

namespace lf {

// One directory (IFD): its tags, and where their values are.
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

// All directories: the chain, and those within them (SubIFDs), 64 at most, of 1024 tags each at
// most. Directories that lie beyond the end of the file are left out, loops are not followed.
std::vector<TiffDirectory> AllTiffDirectories(const ByteSource& source);

}  // namespace lf
