#include <cstddef>
#include <cstdint>

#include "lf/imageio/image_file.h"
#include "lf/imageio/image_probe.h"
#include "lf/imageio/raw_mosaic.h"

namespace {

// What we read of camera raw files ourselves. LibRaw's part is left out: it decodes what people
// took with their cameras, and is not made for hostile bytes.
bool IsRaw(std::string_view file) {
  const lf::ByteSource source = [&](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= file.size()) return 0;
    return file.copy(reinterpret_cast<char*>(to.data()), to.size(), offset);
  };
  const auto format = lf::ProbeImage(source, "fuzz");
  if (!format || *format != lf::ImageFormat::kRaw) return false;
  const auto mosaic = lf::ReadRawMosaic(source, "fuzz");
  if (mosaic) {
    LF_CHECK(mosaic->width > 0 && mosaic->height > 0);
    LF_CHECK(mosaic->black_level.value_or(0) < mosaic->white_level.value_or(65536));
  } else {
    LF_CHECK(mosaic.error().message.starts_with("fuzz: "));
  }
  return true;
}

}  // namespace

// OpenImageIO loses a string where libpng jumps out of it; only our own faults are looked for.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

// Any bytes are an image or an error that names the file. Pictures above a million values are left
// to their headers: decoding them takes long and shows nothing new.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view file(reinterpret_cast<const char*>(bytes), size_bytes);
  if (IsRaw(file)) return 0;
  const auto info = lf::ReadImageInfoBytes(file, "fuzz");
  if (!info) {
    LF_CHECK(info.error().message.starts_with("fuzz: "));
    return 0;
  }
  LF_CHECK(info->width > 0 && info->height > 0 && info->channels > 0);
  if (int64_t{info->width} * info->height > 1'000'000 / info->channels) return 0;
  const auto image = lf::ReadImageBytes(file, "fuzz");
  if (!image) {
    LF_CHECK(image.error().message.starts_with("fuzz: "));
    return 0;
  }
  std::visit(
      [&](const auto& pixels) {
        LF_CHECK(pixels.width() == info->width && pixels.height() == info->height);
        LF_CHECK(pixels.channels() == info->channels);
      },
      *image);
  return 0;
}
