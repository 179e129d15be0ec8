// SPDX-License-Identifier: Apache-2.0
// Any bytes must decode to an image or an error, with equal results from the reference and the fast
// transforms.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/pixels/codec/decode_by.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  const std::string_view code(reinterpret_cast<const char*>(data), size_bytes);
  const lf::Result<lf::CodeInfo> info = lf::ReadCodeInfo(code);
  if (!info) {
    LF_CHECK(info.error().message.starts_with("is "));
    return 0;
  }
  // A store decodes only images of the size that its calibration states. Images of at most
  // kMostPixels on each side are therefore enough here.
  constexpr int kMostPixels = 512;
  const lf::PixelRect wanted = {info->width / 3, info->height / 3, info->width, info->height};
  if (info->width > kMostPixels || info->height > kMostPixels) return 0;
  if (const int reduction = lf::LargestReduction(*info); reduction > 1) {
    lf::CodecPixels fast, slow;
    const auto by_simd = lf::DecodeReducedBy(lf::Transform::kSimd, code, reduction, &fast);
    const auto by_reference =
        lf::DecodeReducedBy(lf::Transform::kReference, code, reduction, &slow);
    LF_CHECK(by_simd.has_value() == by_reference.has_value());
    if (by_simd)
      std::visit(
          [&]<class Pixel>(const lf::Image<Pixel>& image) {
            LF_CHECK(image.pixels() == std::get<lf::Image<Pixel>>(slow).pixels());
          },
          fast);
  }
  lf::DecodedPart fast, slow;
  const auto by_simd = lf::DecodeImageBy(lf::Transform::kSimd, code, wanted, &fast);
  const auto by_reference = lf::DecodeImageBy(lf::Transform::kReference, code, wanted, &slow);
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
