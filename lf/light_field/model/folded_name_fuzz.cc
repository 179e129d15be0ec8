// SPDX-License-Identifier: Apache-2.0
// Folds any bytes as a file name: ASCII letters are small afterwards, and a date is taken off at
// the beginning alone.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "lf/core/check.h"
#include "lf/light_field/model/folded_name.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string name(reinterpret_cast<const char*>(bytes), size_bytes);
  const std::string folded = lf::FoldedName(name);
  LF_CHECK(folded.empty() == name.empty());
  LF_CHECK(std::none_of(folded.begin(), folded.end(), [](char c) { return c >= 'A' && c <= 'Z'; }));
  const std::string rest = lf::WithoutDate(folded);
  LF_CHECK(folded.ends_with(rest) && rest.empty() == folded.empty());
  return 0;
}
