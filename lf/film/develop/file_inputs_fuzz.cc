// SPDX-License-Identifier: Apache-2.0
// Looks for the inputs in any bytes, as in an mp4 file.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/film/develop/file_inputs.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto text = lf::FindInputs(size, [&](uint64_t offset, std::span<char> to) {
    if (offset > size || to.size() > size - offset) return false;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), to.size(), to.begin());
    return true;
  });
  if (!text) return 0;
  LF_CHECK(bytes.find(*text) != std::string_view::npos);
  const lf::FileInputs inputs = lf::InputsOfText(*text);
  // Inputs that are written as a text are as many when the text is read.
  LF_CHECK(lf::InputsOfText(lf::TextOfInputs(inputs)).size() == inputs.size());
  return 0;
}
