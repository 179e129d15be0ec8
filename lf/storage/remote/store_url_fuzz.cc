// SPDX-License-Identifier: Apache-2.0
// Takes any bytes as a URL, as the header Content-Range and as the file FIELD.lfs.url: names of
// local files must stay in their folder, ranges must be in order, and a file must be the text of
// what it says.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/storage/remote/store_note.h"
#include "lf/storage/remote/store_url.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  if (const auto range = lf::ParseContentRange(text)) {
    LF_CHECK(range->begin < range->end);
    LF_CHECK(!range->size || range->end <= *range->size);
  }
  if (const auto note = lf::ParseStoreNote(text)) {
    LF_CHECK(lf::CheckStoreUrl(note->url).has_value());
    LF_CHECK(lf::ParseStoreNote(lf::TextOf(*note)).has_value());
  }
  const std::string shown = lf::ShownUrl(text);
  LF_CHECK(shown.size() <= size_bytes + 2 && shown.find('?') == std::string::npos);
  const std::string name = lf::FolderNameOfUrl(text);
  LF_CHECK(!name.empty() && name.size() < 128 && name[0] != '.');
  LF_CHECK(name.find('/') == std::string::npos && name.find('\0') == std::string::npos);
  if (!lf::CheckStoreUrl(text)) return 0;
  LF_CHECK(lf::PartUrl(text, 3).size() == size_bytes + 3);
  LF_CHECK(lf::CheckStoreUrl(lf::PartUrl(text, 3)).has_value());
  return 0;
}
