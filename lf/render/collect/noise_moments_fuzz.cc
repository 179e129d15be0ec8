// SPDX-License-Identifier: Apache-2.0
// NoiseMoments::Read() must accept or refuse any text. The first line of the input describes a
// plate of 2 x 1 elements: "sum count" for each of the three channels of both elements. The rest is
// the text. If it is accepted, Text() must return it again, and the standard errors must not be
// negative or NaN.
#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/render/collect/noise_moments.h"

namespace {

// Removes the next number from the line and returns it; 0 if there is none or it exceeds `most`.
uint64_t NextNumber(std::string_view* line, uint64_t most) {
  uint64_t number = 0;
  const auto [rest, error] = std::from_chars(line->data(), line->data() + line->size(), number);
  line->remove_prefix(static_cast<size_t>(rest - line->data()));
  if (!line->empty()) line->remove_prefix(1);
  return error == std::errc{} && number <= most ? number : 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  lf::SensorPlate plate(2, 1);
  for (int i = 0; i < 6; ++i) {
    const uint64_t sum = NextNumber(&line, UINT64_MAX);
    const uint64_t count = NextNumber(&line, uint64_t{1} << 44);
    plate.Add(i / 3, 0, i % 3, {std::min(sum, 65535 * count), count});
  }
  const lf::Result<lf::NoiseMoments> moments = lf::NoiseMoments::Read(text, plate);
  if (!moments) {
    LF_CHECK(moments.error().message.starts_with("its number "));
    return 0;
  }
  LF_CHECK(moments->Text() == text);
  for (size_t i = 0; i < 2; ++i)
    for (int c = 0; c < 3; ++c)
      LF_CHECK(lf::StandardErrorOfMean(plate.At(static_cast<int>(i), 0, c), moments->At(i, c)) >=
               0);
  return 0;
}
