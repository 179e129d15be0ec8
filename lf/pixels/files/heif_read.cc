// SPDX-License-Identifier: Apache-2.0
// Reads HEIF files (HEIC of phones, AVIF) by libheif, which is loaded when the first such file is
// read.
#include <fmt/format.h>

#include "lf/pixels/files/picture_decoder.h"

#ifdef LF_HEIF_LIBRARY_NAME
#include <libheif/heif.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/loaded_library.h"

namespace lf {
namespace {

struct HeifCalls {
  LoadedLibrary library{LF_HEIF_LIBRARY_NAME};
  LF_LOADED(heif_context_alloc);
  LF_LOADED(heif_context_free);
  LF_LOADED(heif_context_read_from_reader);
  LF_LOADED(heif_context_get_primary_image_handle);
  LF_LOADED(heif_image_handle_release);
  LF_LOADED(heif_image_handle_get_width);
  LF_LOADED(heif_image_handle_get_height);
  LF_LOADED(heif_image_handle_has_alpha_channel);
  LF_LOADED(heif_image_handle_get_luma_bits_per_pixel);
  LF_LOADED(heif_image_handle_get_list_of_metadata_block_IDs);
  LF_LOADED(heif_image_handle_get_metadata_size);
  LF_LOADED(heif_image_handle_get_metadata);
  LF_LOADED(heif_image_handle_get_raw_color_profile_size);
  LF_LOADED(heif_image_handle_get_raw_color_profile);
  LF_LOADED(heif_decoding_options_alloc);
  LF_LOADED(heif_decoding_options_free);
  LF_LOADED(heif_decode_image);
  LF_LOADED(heif_image_get_width);
  LF_LOADED(heif_image_get_height);
  LF_LOADED(heif_image_get_bits_per_pixel_range);
  LF_LOADED(heif_image_get_plane_readonly);
  LF_LOADED(heif_image_release);
};

const HeifCalls& Heif() {
  static const HeifCalls calls;
  return calls;
}

struct FreeContext {
  void operator()(heif_context* context) const { Heif().heif_context_free(context); }
};
struct ReleaseHandle {
  void operator()(heif_image_handle* handle) const { Heif().heif_image_handle_release(handle); }
};
struct ReleaseImage {
  void operator()(heif_image* image) const { Heif().heif_image_release(image); }
};
struct FreeOptions {
  void operator()(heif_decoding_options* options) const {
    Heif().heif_decoding_options_free(options);
  }
};

constexpr size_t kMostMetadataBytes = size_t{1} << 24;

class HeifDecoder : public PictureDecoder {
 public:
  explicit HeifDecoder(const FileBytes& file) : file_(file) {}

  const ImageFileInfo& info() const override { return info_; }

  std::string IccProfile() const override {
    const size_t size = Heif().heif_image_handle_get_raw_color_profile_size(handle_.get());
    if (size == 0 || size > kMostMetadataBytes) return "";
    std::string profile(size, '\0');
    const heif_error error =
        Heif().heif_image_handle_get_raw_color_profile(handle_.get(), profile.data());
    return error.code == heif_error_Ok ? profile : "";
  }

  std::string Exif() const override {
    heif_item_id id = 0;
    if (Heif().heif_image_handle_get_list_of_metadata_block_IDs(handle_.get(), "Exif", &id, 1) != 1)
      return "";
    const size_t size = Heif().heif_image_handle_get_metadata_size(handle_.get(), id);
    constexpr size_t kOffsetBytes = 4;  // a number says how many bytes precede the TIFF header
    if (size <= kOffsetBytes || size > kMostMetadataBytes) return "";
    std::string block(size, '\0');
    if (Heif().heif_image_handle_get_metadata(handle_.get(), id, block.data()).code !=
        heif_error_Ok)
      return "";
    size_t skipped = 0;
    for (size_t i = 0; i < kOffsetBytes; ++i)
      skipped = skipped << 8 | static_cast<uint8_t>(block[i]);
    return skipped < size - kOffsetBytes ? block.substr(kOffsetBytes + skipped) : "";
  }

  Result<void> Open() {
    const HeifCalls& heif = Heif();
    context_.reset(heif.heif_context_alloc());
    if (!context_) throw std::bad_alloc();
    if (const heif_error error =
            heif.heif_context_read_from_reader(context_.get(), &kReader, this, nullptr);
        error.code != heif_error_Ok)
      return Damaged(error);
    heif_image_handle* handle = nullptr;
    if (const heif_error error =
            heif.heif_context_get_primary_image_handle(context_.get(), &handle);
        error.code != heif_error_Ok)
      return Damaged(error);
    handle_.reset(handle);
    info_.width = heif.heif_image_handle_get_width(handle);
    info_.height = heif.heif_image_handle_get_height(handle);
    info_.channels = heif.heif_image_handle_has_alpha_channel(handle) != 0 ? 4 : 3;
    info_.bits = heif.heif_image_handle_get_luma_bits_per_pixel(handle) > 8 ? 16 : 8;
    info_.channel_names = {"R", "G", "B", "A"};
    info_.channel_names.resize(static_cast<size_t>(info_.channels));
    return CheckPictureSize(info_.width, info_.height, info_.channels, file_.name);
  }

  Result<void> Read(StoredImage* image) override {
    const HeifCalls& heif = Heif();
    const std::unique_ptr<heif_decoding_options, FreeOptions> options(
        heif.heif_decoding_options_alloc());
    if (!options) throw std::bad_alloc();
    options->strict_decoding = 1;
    const bool has_alpha = info_.channels == 4;
    constexpr bool kIsLittle = std::endian::native == std::endian::little;
    const heif_chroma wide = has_alpha ? (kIsLittle ? heif_chroma_interleaved_RRGGBBAA_LE
                                                    : heif_chroma_interleaved_RRGGBBAA_BE)
                                       : (kIsLittle ? heif_chroma_interleaved_RRGGBB_LE
                                                    : heif_chroma_interleaved_RRGGBB_BE);
    const heif_chroma narrow =
        has_alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB;
    heif_image* decoded = nullptr;
    if (const heif_error error =
            heif.heif_decode_image(handle_.get(), &decoded, heif_colorspace_RGB,
                                   info_.bits == 16 ? wide : narrow, options.get());
        error.code != heif_error_Ok)
      return Damaged(error);
    const std::unique_ptr<heif_image, ReleaseImage> owner(decoded);
    int stride = 0;
    const uint8_t* const plane =
        heif.heif_image_get_plane_readonly(decoded, heif_channel_interleaved, &stride);
    if (plane == nullptr ||
        heif.heif_image_get_width(decoded, heif_channel_interleaved) != info_.width ||
        heif.heif_image_get_height(decoded, heif_channel_interleaved) != info_.height)
      return InputError(fmt::format(
          "{}: damaged HEIF file: its picture has another size than its head states", file_.name));
    if (info_.bits == 8)
      CopyRows(plane, stride, 8,
               &Resized<uint8_t>(info_.width, info_.height, info_.channels, image));
    else
      CopyRows(plane, stride,
               heif.heif_image_get_bits_per_pixel_range(decoded, heif_channel_interleaved),
               &Resized<uint16_t>(info_.width, info_.height, info_.channels, image));
    return {};
  }

 private:
  Error Damaged(const heif_error& error) const {
    const std::string_view reason = error.message == nullptr ? "" : error.message;
    if (error.code == heif_error_Memory_allocation_error &&
        error.subcode != heif_suberror_Security_limit_exceeded)
      return OutputError(fmt::format("{}: cannot be read: libheif lacks memory", file_.name));
    if (error.code == heif_error_Unsupported_feature ||
        error.code == heif_error_Unsupported_filetype)
      return InputError(fmt::format(
          "{}: is a HEIF file of a kind that libheif does not read here ({}): convert it to PNG",
          file_.name, reason));
    return InputError(fmt::format("{}: truncated or damaged HEIF file: {}", file_.name, reason));
  }

  // Copies the values, scaled from `bits` to the full range, rounded.
  template <class T>
  void CopyRows(const uint8_t* plane, int stride, int bits, Image<T>* pixels) const {
    const uint32_t highest = (uint32_t{1} << bits) - 1;
    constexpr uint32_t kFull = std::numeric_limits<T>::max();
    const size_t count = static_cast<size_t>(info_.width) * info_.channels;
    for (int y = 0; y < info_.height; ++y) {
      T* const out = pixels->row(y);
      std::memcpy(out, plane + static_cast<ptrdiff_t>(y) * stride, count * sizeof(T));
      if (highest == kFull) continue;
      for (size_t i = 0; i < count; ++i)
        out[i] =
            static_cast<T>((std::min<uint32_t>(out[i], highest) * kFull + highest / 2) / highest);
    }
  }

  // The calls by which libheif reads the file.
  static int64_t Position(void* self) {
    return static_cast<int64_t>(static_cast<HeifDecoder*>(self)->offset_);
  }
  static int ReadBytes(void* to, size_t count, void* self) {
    auto& decoder = *static_cast<HeifDecoder*>(self);
    const size_t done = decoder.file_.read(decoder.offset_, {static_cast<uint8_t*>(to), count});
    decoder.offset_ += done;
    return done == count ? 0 : 1;
  }
  static int Seek(int64_t position, void* self) {
    static_cast<HeifDecoder*>(self)->offset_ = static_cast<uint64_t>(position);
    return 0;
  }
  static heif_reader_grow_status WaitForSize(int64_t size, void* self) {
    const auto& decoder = *static_cast<HeifDecoder*>(self);
    return size < 0 || static_cast<uint64_t>(size) > decoder.file_.size_bytes
               ? heif_reader_grow_status_size_beyond_eof
               : heif_reader_grow_status_size_reached;
  }
  static constexpr heif_reader kReader = {1, Position, ReadBytes, Seek, WaitForSize};

  const FileBytes& file_;
  uint64_t offset_ = 0;  // position of the next byte that libheif reads
  std::unique_ptr<heif_context, FreeContext> context_;
  std::unique_ptr<heif_image_handle, ReleaseHandle> handle_;
  ImageFileInfo info_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenHeif(const FileBytes& file) {
  if (!Heif().library.has_all())
    return MissingAtRunTime(file.name, "HEIF", LF_HEIF_LIBRARY_NAME, "libheif1");
  return Opened<HeifDecoder>(file);
}

}  // namespace lf

#else

namespace lf {
Result<std::unique_ptr<PictureDecoder>> OpenHeif(const FileBytes& file) {
  return MissingLibrary(file.name, "HEIF and AVIF", "libheif");
}
}  // namespace lf

#endif
