// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as a part of a store by resolution, and as the places of an LF image in it. Bytes
// that are read must lie in the file and have the stated checksum.
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/storage/packed/part_file.h"

// The first byte is the number of bytes of the places, which follow. The rest is the file.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("lf_part_fuzz." + std::to_string(::getpid()) + "-r0.lfs");
  if (size_bytes == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size_bytes - 1);
  const size_t text_bytes = std::min<size_t>(data[0], bytes.size());
  const std::string_view file = bytes.substr(text_bytes);
  std::ofstream(path, std::ios::binary)
      .write(file.data(), static_cast<std::streamsize>(file.size()));
  const std::string store = lf::StoreOfPart(path);
  LF_CHECK(store.size() < lf::kPartHeadBytes);
  const auto ranges = lf::RangesOfText(bytes.substr(0, text_bytes), 4);
  if (ranges) LF_CHECK(!ranges->pieces.empty() && ranges->PartOf(ranges->pieces.size() - 1, 4) < 4);
  for (size_t number = 0; number < 2; ++number) {
    const auto part = lf::PartReader::Open(path, store, number);
    LF_CHECK(part || part.error().message.starts_with(path.string()));
    if (!part || !ranges) continue;
    LF_CHECK(part->bytes() == file.size());
    for (const lf::PartRange& piece : ranges->pieces) {
      std::string read;
      const auto result = part->Read(piece, &read);
      LF_CHECK(result || result.error().message.starts_with(path.string()));
      LF_CHECK(!result || (read == file.substr(piece.begin, piece.bytes) &&
                           lf::HashBytes(read) == piece.hash));
    }
  }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return 0;
}
