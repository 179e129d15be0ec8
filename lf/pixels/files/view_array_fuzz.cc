// SPDX-License-Identifier: Apache-2.0
// Any bytes must give an error that names the file, or an array whose views lie in the file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/pixels/files/view_array.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view file(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto array = lf::ParseViewArray(file, size_bytes, "fuzz");
  if (!array) {
    LF_CHECK(array.error().message.starts_with("fuzz: "));
    return 0;
  }
  const uint64_t values = uint64_t{1} * array->rows * array->columns * array->info.width *
                          array->info.height * array->info.channels;
  LF_CHECK(array->rows >= 1 && array->columns >= 1 && array->info.channels <= 4);
  LF_CHECK(array->values_begin + values * array->value_bytes == size_bytes);
  return 0;
}
