// SPDX-License-Identifier: Apache-2.0
// Reads WebP files by libwebp. The container is that of
// https://developers.google.com/speed/webp/docs/riff_container.
#include <fmt/format.h>

#include "lf/pixels/files/picture_decoder.h"

#ifdef LF_HAS_WEBP
#include <webp/decode.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/files/exif_orientation.h"

namespace lf {
namespace {

constexpr uint64_t kRiffHeadBytes = 12, kChunkHeadBytes = 8;
constexpr uint32_t kMostMetadataBytes = 1 << 24;

class WebpDecoder : public PictureDecoder {
 public:
  explicit WebpDecoder(const FileBytes& file) : file_(file) {}

  const ImageFileInfo& info() const override { return info_; }
  std::string IccProfile() const override { return icc_; }
  std::string Exif() const override { return exif_; }

  Result<void> Open() {
    LF_RETURN_IF_ERROR(ReadChunks());
    constexpr size_t kHeadBytes = 4096;
    const std::string start = StartOf(file_, kHeadBytes);
    WebPBitstreamFeatures features;
    const VP8StatusCode status =
        WebPGetFeatures(reinterpret_cast<const uint8_t*>(start.data()), start.size(), &features);
    if (status != VP8_STATUS_OK) return Damaged(status);
    if (features.has_animation != 0)
      return InputError(fmt::format(
          "{}: is an animated WebP file: expected a single picture; extract one", file_.name));
    info_.width = features.width;
    info_.height = features.height;
    info_.channels = features.has_alpha != 0 ? 4 : 3;
    info_.bits = 8;
    info_.channel_names = {"R", "G", "B", "A"};
    info_.channel_names.resize(static_cast<size_t>(info_.channels));
    info_.orientation =
        OrientationOfTiff({reinterpret_cast<const uint8_t*>(exif_.data()), exif_.size()});
    return CheckPictureSize(info_.width, info_.height, info_.channels, file_.name);
  }

  Result<void> Read(StoredImage* image) override {
    std::string storage;
    const std::string_view bytes = ContentOf(file_, &storage);
    Image<uint8_t>& pixels = Resized<uint8_t>(info_.width, info_.height, info_.channels, image);
    WebPDecoderConfig config;
    LF_CHECK(WebPInitDecoderConfig(&config) != 0);
    config.output.colorspace = info_.channels == 4 ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = pixels.row(0);
    config.output.u.RGBA.stride = info_.width * info_.channels;
    config.output.u.RGBA.size = pixels.size_bytes();
    const VP8StatusCode status =
        WebPDecode(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &config);
    WebPFreeDecBuffer(&config.output);
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_OK) return Damaged(status);
    return {};
  }

 private:
  Error Damaged(VP8StatusCode status) const {
    const char* const reason = status == VP8_STATUS_NOT_ENOUGH_DATA       ? "it ends too early"
                               : status == VP8_STATUS_UNSUPPORTED_FEATURE ? "unknown feature"
                                                                          : "wrong bits";
    return InputError(fmt::format("{}: truncated or damaged WebP file: {}", file_.name, reason));
  }

  // Checks that all chunks lie in the file, and reads the profile and the Exif data.
  Result<void> ReadChunks() {
    const std::string head = StartOf(file_, kRiffHeadBytes);
    const uint64_t end = head.size() < kRiffHeadBytes ? 0 : 8 + Number(head.substr(4, 4));
    if (end < kRiffHeadBytes || end > file_.size_bytes) return Damaged(VP8_STATUS_NOT_ENOUGH_DATA);
    uint64_t offset = kRiffHeadBytes;
    while (offset + kChunkHeadBytes <= end) {
      std::string chunk(kChunkHeadBytes, '\0');
      if (!Copy(offset, &chunk)) return Damaged(VP8_STATUS_NOT_ENOUGH_DATA);
      const uint32_t size = Number(chunk.substr(4, 4));
      offset += kChunkHeadBytes;
      if (size > end - offset) return Damaged(VP8_STATUS_NOT_ENOUGH_DATA);
      const std::string type = chunk.substr(0, 4);
      std::string* const kept = type == "ICCP" ? &icc_ : type == "EXIF" ? &exif_ : nullptr;
      if (kept != nullptr && kept->empty() && size <= kMostMetadataBytes) {
        kept->resize(size);
        if (!Copy(offset, kept)) return Damaged(VP8_STATUS_NOT_ENOUGH_DATA);
      }
      offset += size + size % 2;
    }
    // Some programs write the mark of JPEG files before the TIFF header.
    constexpr std::string_view kJpegMark("Exif\0\0", 6);
    if (exif_.starts_with(kJpegMark)) exif_.erase(0, kJpegMark.size());
    return {};
  }

  bool Copy(uint64_t offset, std::string* to) const {
    return file_.read(offset, {reinterpret_cast<uint8_t*>(to->data()), to->size()}) == to->size();
  }

  static uint32_t Number(std::string_view bytes) {
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;) value = value << 8 | static_cast<uint8_t>(bytes[i]);
    return value;
  }

  const FileBytes& file_;
  ImageFileInfo info_;
  std::string icc_, exif_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenWebp(const FileBytes& file) {
  return Opened<WebpDecoder>(file);
}

}  // namespace lf

#else

namespace lf {
Result<std::unique_ptr<PictureDecoder>> OpenWebp(const FileBytes& file) {
  return MissingLibrary(file.name, "WebP", "libwebp");
}
}  // namespace lf

#endif
