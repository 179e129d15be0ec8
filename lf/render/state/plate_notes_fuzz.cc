// SPDX-License-Identifier: Apache-2.0
// PlateNotesOf() must accept or refuse any lines "key: value". Notes that it accepts must not
// change when they are written and read again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/render/state/plate_notes.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::PlateEntries entries;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const size_t colon = line.find(": ");
    if (colon == std::string_view::npos) continue;
    entries.emplace_back(line.substr(0, colon), line.substr(colon + 2));
  }
  constexpr int kWidth = 20, kHeight = 17;
  const lf::Result<lf::PlateNotes> notes = lf::PlateNotesOf(entries, kWidth, kHeight, "p");
  if (!notes) {
    LF_CHECK(notes.error().message.starts_with("p: "));
    return 0;
  }
  const lf::PlateEntries written = lf::TextOf(*notes);
  const lf::Result<lf::PlateNotes> again = lf::PlateNotesOf(written, kWidth, kHeight, "p");
  LF_CHECK(again.has_value());
  LF_CHECK(lf::TextOf(*again) == written);
  return 0;
}
