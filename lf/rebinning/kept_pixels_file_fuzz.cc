// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as a file of kept pixels: this must fail with an error, or return pixels that LF
// images can have, and that can be loaded. The checksums of the head and of the LF images are
// corrected first, because otherwise the code after their tests would never be reached.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/rebinning/kept_pixels_file.h"
#include "lf/rebinning/kept_pixels_format.h"

namespace {

void MakeChecksumsRight(std::string* bytes) {
  using namespace lf::kept_pixels_format;
  FileHead head;
  if (bytes->size() < sizeof(head)) return;
  std::memcpy(&head, bytes->data(), sizeof(head));
  size_t at = sizeof(head) + std::min<size_t>(head.text_bytes, bytes->size());
  if (at + sizeof(uint64_t) > bytes->size()) return;
  const uint64_t hash = lf::HashBytes(std::string_view(*bytes).substr(0, at));
  std::memcpy(bytes->data() + at, &hash, sizeof(hash));
  at += sizeof(hash);
  while (bytes->size() - at >= sizeof(ImageHead)) {
    ImageHead image;
    std::memcpy(&image, bytes->data() + at, sizeof(image));
    const uint64_t sizes[] = {uint64_t{image.mask_words} * 8, uint64_t{image.pixel_count} * 4,
                              image.pixel_count * 2 * ValueCount(image),
                              uint64_t{image.depth_width} * image.depth_height * 2};
    uint64_t size = sizeof(image);
    for (const uint64_t part : sizes) {
      if (part > bytes->size() - at - size) return;
      size += part;
    }
    const uint64_t of_image =
        lf::HashBytes(std::string_view(*bytes).substr(at + sizeof(hash), size - sizeof(hash)));
    std::memcpy(bytes->data() + at, &of_image, sizeof(of_image));
    at += size;
  }
}

void CheckImage(const lf::KeptPixels& pixels, const lf::KeptImage& image) {
  const lf::PixelRect whole = {0, 0, image.width_px, image.height_px};
  LF_CHECK(image.rect.empty() || lf::Intersection(image.rect, whole) == image.rect);
  LF_CHECK(image.values.size() == image.places.size() * image.value_count());
  LF_CHECK(image.masked.empty() || image.masked.size() == image.masked_words());
  LF_CHECK(image.depths.divisor >= 1);
  for (size_t i = 0; i < image.places.size(); ++i) {
    LF_CHECK(image.places[i] < image.rect.pixel_count());
    LF_CHECK(i == 0 || image.places[i] > image.places[i - 1]);
  }
  // Interpolation allocates the whole rectangle, which may be large although the file is small.
  if (image.rect.pixel_count() > 4096) return;
  lf::LfPixels loaded;
  pixels.Load(image.id, image.rect, &loaded);
  for (int y = 0; y < image.rect.height(); ++y)
    for (int x = 0; x < image.rect.width(); ++x) {
      if (image.masked.empty()) continue;
      const uint32_t place = image.PlaceOf(image.rect.x_begin + x, image.rect.y_begin + y);
      if ((image.masked[place / 64] >> (place % 64) & 1) != 0) LF_CHECK(loaded.IsMasked(x, y));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  constexpr size_t kMaxPixels = 100;
  static lf::ThreadPool* const pool = new lf::ThreadPool(1);
  std::string bytes(reinterpret_cast<const char*>(data), size_bytes);
  MakeChecksumsRight(&bytes);
  const lf::Result<lf::KeptFile> read = lf::ReadKeptOfBytes(bytes, "k", kMaxPixels, *pool);
  if (!read) {
    LF_CHECK(read.error().message.starts_with("k: "));
    return 0;
  }
  LF_CHECK(read->pixels.size() <= kMaxPixels);
  size_t count = 0;
  for (const auto& [id, image] : read->pixels.images()) {
    LF_CHECK(id == image.id);
    CheckImage(read->pixels, image);
    count += image.places.size();
  }
  LF_CHECK(count == read->pixels.size());
  return 0;
}
