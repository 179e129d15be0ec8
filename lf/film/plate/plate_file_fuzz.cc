// SPDX-License-Identifier: Apache-2.0
// Any bytes must give a plate or an error, and each sum of a plate must be possible for its number
// of rays. All checksums are corrected first, because otherwise nothing behind their checks would
// be reached.
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

void MakeChecksumsRight(std::string* bytes) {
  using namespace lf::plate_format;
  Head head;
  if (bytes->size() < sizeof(head)) return;
  std::memcpy(&head, bytes->data(), sizeof(head));
  size_t at = sizeof(head) + std::min<size_t>(head.text_bytes, bytes->size());
  const auto put = [&](size_t place, uint64_t hash) {
    if (place + sizeof(hash) <= bytes->size())
      std::memcpy(bytes->data() + place, &hash, sizeof(hash));
  };
  if (at > bytes->size()) return;
  put(at, lf::HashBytes(std::string_view(*bytes).substr(0, at)));
  at += sizeof(uint64_t);
  const uint32_t rows = std::max(1u, head.rows_per_chunk);
  const uint32_t chunk_count = std::min(1000u, (head.height + rows - 1) / rows);
  for (uint32_t chunk = 0; chunk < chunk_count && at + sizeof(ChunkHead) <= bytes->size();
       ++chunk) {
    ChunkHead chunk_head;
    std::memcpy(&chunk_head, bytes->data() + at, sizeof(chunk_head));
    at += sizeof(chunk_head);
    if (chunk_head.stored_bytes > bytes->size() - at) return;
    put(at - sizeof(uint64_t),
        lf::HashBytes(std::string_view(*bytes).substr(at, chunk_head.stored_bytes), chunk));
    at += chunk_head.stored_bytes;
  }
  if (bytes->size() >= at + sizeof(uint64_t)) {
    const size_t wide_bytes = bytes->size() - at - sizeof(uint64_t);
    put(at + wide_bytes, lf::HashBytes(std::string_view(*bytes).substr(at, wide_bytes)));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  std::string bytes(reinterpret_cast<const char*>(data), size_bytes);
  MakeChecksumsRight(&bytes);
  lf::Result<lf::PlateReader> reader = lf::PlateReader::OpenBytes(bytes, "p");
  if (!reader) {
    LF_CHECK(reader.error().message.starts_with("p: "));
    return 0;
  }
  // Callers refuse plates of another size than they expect, so that very large ones need no test.
  if (int64_t{reader->width()} * reader->height() > 1 << 20) return 0;
  lf::SensorPlate plate(reader->width(), reader->height(), reader->kind());
  const lf::Result<void> added = reader->AddTo(&plate);
  if (!added) {
    LF_CHECK(added.error().message.starts_with("p: "));
    return 0;
  }
  uint64_t rays = 0;
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int c = 0; c < plate.channels(); ++c) {
        const lf::ElementSum element = plate.At(x, y, c);
        LF_CHECK(element.sum <= 65535 * element.count);
        rays += element.count;
      }
  return rays == UINT64_MAX;
}
