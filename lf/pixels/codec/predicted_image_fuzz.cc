// SPDX-License-Identifier: Apache-2.0
// Any bytes must decode to an image or an error from any reference images, with equal results from
// the reference implementation and the fast one.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/random.h"
#include "lf/pixels/codec/decode_by.h"
#include "lf/pixels/codec/predicted_image.h"

namespace {

// Largest number of pixels of an image here: a store decodes only images of the size that its
// calibration states.
constexpr long long kMostPixels = 1 << 16;

template <class Pixel>
lf::CodecPixels Pattern(const lf::PixelRect& rect, int channels) {
  lf::Image<Pixel> image(rect.width(), rect.height(), channels);
  uint64_t index = 0;
  for (Pixel& value : image.pixels()) value = static_cast<Pixel>(lf::MixBits(index++));
  return image;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  const std::string_view code(reinterpret_cast<const char*>(data), size_bytes);
  const lf::Result<lf::CodeInfo> info = lf::ReadCodeInfo(code);
  if (!info || static_cast<long long>(info->width) * info->height > kMostPixels) return 0;
  const lf::PixelRect wanted = {info->width / 3, info->height / 3, info->width, info->height};
  const auto needed = lf::NeededOfReferences(code, wanted);
  if (!needed) {
    LF_CHECK(needed.error().message.starts_with("is "));
    return 0;
  }
  std::vector<lf::DecodedPart> references;
  for (const lf::PixelRect& rect : *needed) {
    if (rect.pixel_count() > kMostPixels) return 0;
    const int channels = info->layout == lf::PixelLayout::kRgb ? 3 : 1;
    references.push_back(
        {info->bits == 8 ? Pattern<uint8_t>(rect, channels) : Pattern<uint16_t>(rect, channels),
         rect});
  }
  std::vector<const lf::DecodedPart*> parts;
  for (const lf::DecodedPart& reference : references) parts.push_back(&reference);
  lf::DecodedPart fast, slow;
  const auto by_simd = lf::DecodePredictedBy(lf::Transform::kSimd, code, parts, wanted, &fast);
  const auto by_reference =
      lf::DecodePredictedBy(lf::Transform::kReference, code, parts, wanted, &slow);
  LF_CHECK(by_simd.has_value() == by_reference.has_value());
  if (!by_simd) {
    LF_CHECK(by_simd.error().message == by_reference.error().message);
    return 0;
  }
  LF_CHECK(fast.rect == slow.rect && lf::Intersection(wanted, fast.rect) == wanted);
  std::visit(
      [&]<class Pixel>(const lf::Image<Pixel>& image) {
        LF_CHECK(image.pixels() == std::get<lf::Image<Pixel>>(slow.pixels).pixels());
      },
      fast.pixels);
  return 0;
}
