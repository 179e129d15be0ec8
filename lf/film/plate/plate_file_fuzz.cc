// SPDX-License-Identifier: Apache-2.0
// Any bytes must give a plate or an error, each sum of a plate or of its gaps must be possible for
// its number of rays, and shares are from 0 to 1. All checksums are corrected first, because
// otherwise nothing behind their checks would be reached.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/plate_format.h"

namespace {

using namespace lf::plate_format;

// Corrects the checksums of a plate's file, from front to back.
class Checksums {
 public:
  explicit Checksums(std::string* bytes) : bytes_(*bytes) {}

  void MakeRight() {
    Head head;
    if (bytes_.size() < sizeof(head)) return;
    std::memcpy(&head, bytes_.data(), sizeof(head));
    at_ = sizeof(head) + std::min<size_t>(head.text_bytes, bytes_.size());
    if (at_ > bytes_.size()) return;
    Put(HashBytes(0, at_));
    const uint32_t rows = std::max(1u, head.rows_per_chunk);
    const uint32_t chunk_count = std::min(1000u, (head.height + rows - 1) / rows);
    if (!Chunks(0, chunk_count)) return;
    Wide(head.wide_count);
    GapHead gaps;
    if (head.version != kVersionWithGaps || bytes_.size() < at_ + sizeof(gaps)) return;
    std::memcpy(&gaps, bytes_.data() + at_, sizeof(gaps));
    at_ += sizeof(gaps.wide_count);
    Put(HashBytes(at_ - sizeof(gaps.wide_count), sizeof(gaps.wide_count)));
    if (!Chunks(chunk_count, chunk_count)) return;
    Wide(gaps.wide_count);
    Chunks(2 * chunk_count, chunk_count);
  }

 private:
  uint64_t HashBytes(size_t begin, size_t size, uint64_t seed = 0) const {
    return lf::HashBytes(std::string_view(bytes_).substr(begin, size), seed);
  }
  // Writes a hash where the file has one.
  void Put(uint64_t hash) {
    if (at_ + sizeof(hash) <= bytes_.size()) std::memcpy(bytes_.data() + at_, &hash, sizeof(hash));
    at_ = std::min(bytes_.size(), at_ + sizeof(hash));
  }
  // False: the file ends before the chunks do.
  bool Chunks(uint32_t first_number, uint32_t count) {
    for (uint32_t chunk = 0; chunk < count; ++chunk) {
      ChunkHead head;
      if (at_ + sizeof(head) > bytes_.size()) return false;
      std::memcpy(&head, bytes_.data() + at_, sizeof(head));
      const size_t begin = at_ + sizeof(head);
      if (head.stored_bytes > bytes_.size() - begin) return false;
      at_ = begin - sizeof(head.hash);
      Put(HashBytes(begin, head.stored_bytes, first_number + chunk));
      at_ = begin + head.stored_bytes;
    }
    return true;
  }
  void Wide(uint64_t count) {
    const size_t left = bytes_.size() - at_;
    const size_t size =
        static_cast<size_t>(std::min<uint64_t>(count, left / sizeof(WideWord)) * sizeof(WideWord));
    at_ += size;
    Put(HashBytes(at_ - size, size));
  }

  std::string& bytes_;
  size_t at_ = 0;
};

// True if each sum is possible for its number of rays.
bool IsPossible(const lf::SensorPlate& plate) {
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int c = 0; c < plate.channels(); ++c) {
        const lf::ElementSum element = plate.At(x, y, c);
        if (element.sum > 65535 * element.count) return false;
      }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  std::string bytes(reinterpret_cast<const char*>(data), size_bytes);
  Checksums(&bytes).MakeRight();
  lf::Result<lf::PlateReader> reader = lf::PlateReader::OpenBytes(bytes, "p");
  if (!reader) {
    LF_CHECK(reader.error().message.starts_with("p: "));
    return 0;
  }
  // Callers refuse plates of another size than they expect, so that very large ones need no test.
  if (int64_t{reader->width()} * reader->height() > 1 << 20) return 0;
  lf::SensorPlate plate(reader->width(), reader->height(), reader->kind());
  lf::Result<void> added = reader->AddTo(&plate);
  lf::PlateGaps gaps;
  if (added && reader->has_gaps()) added = reader->AddGapsTo(&gaps);
  if (!added) {
    LF_CHECK(added.error().message.starts_with("p: "));
    return 0;
  }
  LF_CHECK(IsPossible(plate));
  if (!reader->has_gaps()) return 0;
  LF_CHECK(IsPossible(gaps.rays) && gaps.rays.has_opacity() == plate.has_opacity());
  for (const float share : gaps.share.pixels()) LF_CHECK(share >= 0 && share <= 1);
  return 0;
}
