// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/image_probe.h"
#include "lf/pixels/files/read_jpeg.h"

namespace {

// Returns true if `image` equals `whole` in the wanted part.
bool SamePixels(const lf::Image<uint8_t>& whole, const lf::Image<uint8_t>& image,
                const lf::PixelRect& rect, const lf::PixelRect& wanted) {
  for (int y = wanted.y_begin; y < wanted.y_end; ++y)
    for (int x = wanted.x_begin; x < wanted.x_end; ++x)
      for (int c = 0; c < whole.channels(); ++c)
        if (whole.at(x, y, c) != image.at(x - rect.x_begin, y - rect.y_begin, c)) return false;
  return true;
}

}  // namespace

// The first eight bytes tell which part is wanted; the rest is the file. Any file must give either
// an error, which names the file and does not depend on the wanted part, or a picture. The wanted
// part must equal that part of the whole picture. A reduced picture must find the same damage.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  uint16_t corner[4];
  if (size_bytes < sizeof(corner)) return 0;
  std::memcpy(corner, bytes, sizeof(corner));
  const std::string_view file(reinterpret_cast<const char*>(bytes) + sizeof(corner),
                              size_bytes - sizeof(corner));
  const lf::ByteSource source = [&](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= file.size()) return 0;
    return file.copy(reinterpret_cast<char*>(to.data()), to.size(), offset);
  };
  const auto format = lf::ProbeImage(source, "fuzz");
  if (!format || *format != lf::ImageFormat::kJpeg) return 0;
  auto reader = lf::JpegReader::Open(source, "fuzz");
  if (!reader) {
    LF_CHECK(reader.error().message.starts_with("fuzz: "));
    return 0;
  }
  const lf::ImageFileInfo info = reader->info();
  LF_CHECK(info.width > 0 && info.height > 0 && (info.channels == 1 || info.channels == 3));
  if (int64_t{info.width} * info.height > 300'000) return 0;
  lf::PixelRect wanted = {corner[0] % info.width, corner[1] % info.height, 0, 0};
  wanted.x_end = wanted.x_begin + 1 + corner[2] % (info.width - wanted.x_begin);
  wanted.y_end = wanted.y_begin + 1 + corner[3] % (info.height - wanted.y_begin);

  lf::Image<uint8_t> part, whole;
  const auto part_rect = reader->Read(wanted, &part);
  auto again = lf::JpegReader::Open(source, "fuzz");
  LF_CHECK(again.has_value());
  const auto whole_rect = again->Read({0, 0, info.width, info.height}, &whole);
  LF_CHECK(part_rect.has_value() == whole_rect.has_value());
  auto third = lf::JpegReader::Open(source, "fuzz");
  LF_CHECK(third.has_value());
  const int reduction = 2 << corner[0] % 3;
  lf::Image<uint8_t> reduced;
  LF_CHECK(third->ReadReduced(reduction, &reduced).has_value() == whole_rect.has_value());
  if (!part_rect) {
    LF_CHECK(part_rect.error().message.starts_with("fuzz: "));
    return 0;
  }
  LF_CHECK(lf::Intersection(*part_rect, wanted) == wanted);
  LF_CHECK(SamePixels(whole, part, *part_rect, wanted));
  LF_CHECK(reduced.width() == (info.width + reduction - 1) / reduction);
  LF_CHECK(reduced.height() == (info.height + reduction - 1) / reduction);
  return 0;
}
