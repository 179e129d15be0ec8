// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "lf/pixels/files/picture_encoder.h"
#include "lf/pixels/files/png_calls.h"
#include "lf/pixels/files/row_blocks.h"
#include "lf/pixels/files/write_png.h"

namespace lf {
namespace {

// Moderate compression. Stronger compression would make files at most a twentieth smaller, but
// would take most of a frame's encoding time.
constexpr int kCompressionLevel = 4;

// Largest length of a keyword of a text (PNG, third edition, 11.3.3.2).
constexpr size_t kMostKeyCharacters = 79;

// The entries of the metadata, in the form that libpng takes.
class Texts {
 public:
  explicit Texts(const ImageMetadata& metadata) {
    for (const auto& [key, value] : metadata)
      entries_.emplace_back(key.substr(0, kMostKeyCharacters), TextOf(value));
    for (auto& [key, text] : entries_) {
      png_text& of_png = texts_.emplace_back();
      of_png.compression = PNG_TEXT_COMPRESSION_NONE;
      of_png.key = key.data();
      of_png.text = text.data();
      of_png.text_length = text.size();
    }
  }
  const png_text* data() const { return texts_.data(); }
  int size() const { return static_cast<int>(texts_.size()); }

 private:
  std::vector<std::pair<std::string, std::string>> entries_;
  std::vector<png_text> texts_;
};

class PngEncoder {
 public:
  explicit PngEncoder(const PictureRows& picture) : picture_(picture) {}
  ~PngEncoder() { png_destroy_write_struct(&png_, &png_info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  Result<void> WriteHeader();
  Result<void> WriteRows(const std::byte* rows, size_t row_bytes, int count);
  Result<std::string> Finish();

 private:
  static void WriteBytes(png_structp png, png_bytep bytes, size_t count);
  template <class Calls>
  Result<void> Run(const Calls& calls);
  Result<void> CreateStructs();
  void SetHeader();

  const PictureRows& picture_;
  std::string bytes_;
  PngCalls calls_;
  png_structp png_ = nullptr;
  png_infop png_info_ = nullptr;
};

void PngEncoder::WriteBytes(png_structp png, png_bytep bytes, size_t count) {
  PngEncoder& encoder = *static_cast<PngEncoder*>(png_get_io_ptr(png));
  encoder.calls_.Guard([&] { encoder.bytes_.append(reinterpret_cast<const char*>(bytes), count); });
}

// Calls `calls`. kOutput if libpng reported an error.
template <class Calls>
Result<void> PngEncoder::Run(const Calls& calls) {
  if (calls_.Run(calls)) return {};
  return OutputError(fmt::format("{}: cannot be encoded: {}", picture_.name, calls_.message()));
}

Result<void> PngEncoder::CreateStructs() {
  LF_RETURN_IF_ERROR(Run([&] {
    png_ = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &calls_, PngCalls::OnError,
                                     PngCalls::IgnoreWarning, &calls_, PngCalls::Allocate,
                                     PngCalls::Free);
    if (png_ != nullptr) png_info_ = png_create_info_struct(png_);
  }));
  if (png_info_ == nullptr) throw std::bad_alloc();
  return {};
}

void PngEncoder::SetHeader() {
  constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                  PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_IHDR(png_, png_info_, static_cast<png_uint_32>(picture_.width),
               static_cast<png_uint_32>(picture_.height),
               picture_.type == PixelType::kUint16 ? 16 : 8, kColourTypes[picture_.channels - 1],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png_, kCompressionLevel);
  // libpng's default, Z_FILTERED, makes a smooth picture with noise 7 % larger.
  png_set_compression_strategy(png_, Z_DEFAULT_STRATEGY);
  if (picture_.is_srgb) png_set_sRGB_gAMA_and_cHRM(png_, png_info_, PNG_sRGB_INTENT_ABSOLUTE);
}

Result<void> PngEncoder::WriteHeader() {
  LF_RETURN_IF_ERROR(CreateStructs());
  const Texts texts(picture_.metadata);
  return Run([&] {
    png_set_write_fn(png_, this, WriteBytes, [](png_structp) {});
    SetHeader();
    if (texts.size() > 0) png_set_text(png_, png_info_, texts.data(), texts.size());
    png_write_info(png_, png_info_);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
  });
}

Result<void> PngEncoder::WriteRows(const std::byte* rows, size_t row_bytes, int count) {
  return Run([&] {
    for (int i = 0; i < count; ++i)
      png_write_row(png_, reinterpret_cast<png_const_bytep>(rows + row_bytes * i));
  });
}

Result<std::string> PngEncoder::Finish() {
  LF_RETURN_IF_ERROR(Run([&] { png_write_end(png_, nullptr); }));
  return std::move(bytes_);
}

}  // namespace

Result<std::string> EncodePng(const PictureRows& picture) {
  LF_CHECK(picture.channels >= 1 && picture.channels <= 4);
  LF_CHECK(picture.type == PixelType::kUint8 || picture.type == PixelType::kUint16);
  PngEncoder encoder(picture);
  LF_RETURN_IF_ERROR(encoder.WriteHeader());
  LF_RETURN_IF_ERROR(
      EncodeInBlocks(picture, [&](const std::byte* rows, size_t row_bytes, int count) {
        return encoder.WriteRows(rows, row_bytes, count);
      }));
  return encoder.Finish();
}

Result<std::string> EncodePng(ImageView<const uint8_t> pixels) {
  PictureRows rows;
  rows.name = "a PNG";
  rows.width = pixels.width;
  rows.height = pixels.height;
  rows.channels = pixels.channels;
  rows.is_srgb = pixels.channels >= 3;
  rows.pack_row = [&](int y, std::byte* to) {
    std::memcpy(to, pixels.data + y * pixels.stride,
                static_cast<size_t>(pixels.width) * pixels.channels);
  };
  return EncodePng(rows);
}

}  // namespace lf
