// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "lf/core/parse_number.h"
#include "lf/pixels/files/exif_orientation.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/png_calls.h"
#include "lf/pixels/files/stated_camera.h"

namespace lf {
namespace {

// Largest size of a chunk of text that is read, after decompression. Exif data have at most 64 KB,
// and take up to three times this size as hexadecimal text.
constexpr png_alloc_size_t kMostTextBytes = png_alloc_size_t{1} << 20;

// libpng keeps fewer chunks of text than this number. The others are ignored, because compressed
// text could fill the memory.
constexpr png_uint_32 kMostTexts = 65;

// Colours of a palette, with alpha.
struct Palette {
  std::array<std::array<uint8_t, 4>, PNG_MAX_PALETTE_LENGTH> colours = {};
  int size = 0;
};

// Types of the chunks that pixels do not depend on.
constexpr std::string_view kHarmlessTypes =
    "bKGD cHRM eXIf gAMA hIST iCCP iTXt oFFs pCAL pHYs sBIT sCAL sPLT sRGB sTER tEXt tIME zTXt";

// Returns true if, after this warning, libpng continues with pixels that are missing or guessed, or
// if the checksum of the compressed pixels is wrong. A warning names the type of the chunk: "tEXt:
// CRC error". Data behind the last pixel are harmless. A damaged chunk of an unknown type may be
// one that the pixels depend on, because its type may be damaged.
bool IsAboutPixels(std::string_view warning) {
  if (warning.starts_with("IDAT: "))
    return !warning.ends_with("Extra compressed data") && !warning.ends_with("Too much image data");
  if (warning.starts_with("tRNS: ")) return !warning.ends_with("invalid with alpha channel");
  if (warning.ends_with(": CRC error"))
    return kHarmlessTypes.find(warning.substr(0, 4)) == std::string_view::npos;
  return warning == "PLTE: tRNS must be after";
}

void OnWarning(png_structp png, png_const_charp warning) {
  if (IsAboutPixels(warning)) png_error(png, warning);
}

// Returns the bytes of a "raw profile", as ImageMagick stores Exif data in a chunk of text: an
// empty line, a line with the kind, a line with the length, and lines of hexadecimal digits.
std::vector<uint8_t> BytesOfRawProfile(std::string_view text) {
  for (int line = 0; line < 3; ++line) {
    const size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  std::vector<uint8_t> bytes;
  int digits = 0;
  for (const char c : text) {
    const size_t value = std::string_view("0123456789abcdef").find(c);
    if (value == std::string_view::npos) continue;
    if (digits++ % 2 == 0)
      bytes.push_back(static_cast<uint8_t>(value << 4));
    else
      bytes.back() = static_cast<uint8_t>(bytes.back() | value);
  }
  return bytes;
}

// Returns the orientation that the Exif data before the pixels state; 1 if they state none.
int OrientationOf(png_structp png, png_infop info) {
  png_uint_32 size = 0;
  png_bytep exif = nullptr;
  if (png_get_eXIf_1(png, info, &size, &exif) != 0) return OrientationOfTiff({exif, size});
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(png, info, &texts, &count);
  for (const png_text& text : std::span(texts, static_cast<size_t>(count)))
    if (std::string_view(text.key) == "Raw profile type exif")
      return OrientationOfExif(BytesOfRawProfile({text.text, text.text_length}));
  return 1;
}

// Returns the frame rate that a text before the pixels states.
std::optional<double> FrameRateOf(png_structp png, png_infop info) {
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(png, info, &texts, &count);
  for (const png_text& text : std::span(texts, static_cast<size_t>(count))) {
    if (std::string_view(text.key) != kFrameRateText) continue;
    const auto rate = ParseNumber({text.text, text.text_length});
    if (rate && *rate > 0) return rate;
  }
  return std::nullopt;
}

// Returns the text before the pixels that has this key; "" if there is none.
std::string TextBeforePixels(png_structp png, png_infop info, const char* key) {
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(png, info, &texts, &count);
  for (const png_text& text : std::span(texts, static_cast<size_t>(count)))
    if (std::string_view(text.key) == key) return {text.text, text.text_length};
  return "";
}

// Replaces the indices in the last `width` bytes of a row by colours of `channels` bytes. Returns
// the first index that the palette lacks, or -1.
int ReplaceIndices(const Palette& palette, int width, int channels, uint8_t* row) {
  // Index x lies behind the colours of the pixels before x, so it is read before it is overwritten.
  const uint8_t* indices = row + static_cast<size_t>(width) * (channels - 1);
  for (int x = 0; x < width; ++x) {
    const int index = indices[x];
    if (index >= palette.size) return index;
    row = std::copy_n(palette.colours[index].begin(), channels, row);
  }
  return -1;
}

class PngDecoder : public PictureDecoder {
 public:
  explicit PngDecoder(const FileBytes& file) : file_(file) {}
  ~PngDecoder() override { png_destroy_read_struct(&png_, &png_info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  const ImageFileInfo& info() const override { return info_; }
  ColourFacts colours() const override { return colours_; }
  std::string Text(const char* key) const override {
    return TextBeforePixels(png_, png_info_, key);
  }
  std::string IccProfile() const override {
    png_charp name = nullptr;
    int compression = 0;
    png_bytep bytes = nullptr;
    png_uint_32 size = 0;
    if (png_get_iCCP(png_, png_info_, &name, &compression, &bytes, &size) == 0) return "";
    return {reinterpret_cast<const char*>(bytes), size};
  }
  Result<void> Open();
  Result<void> Read(StoredImage* image) override;

 private:
  static void ReadBytes(png_structp png, png_bytep to, size_t count);
  template <class Calls>
  Result<void> Run(const Calls& calls);
  Result<void> CreateStructs();
  void ReadHeader();
  void ReadPalette();
  int SetTransforms();
  template <class T>
  Result<void> ReadRows(Image<T>* image);
  Result<void> ReplaceAllIndices(Image<uint8_t>* image) const;

  const FileBytes& file_;
  uint64_t offset_ = 0;  // position of the next byte that libpng reads
  PngCalls calls_;
  png_structp png_ = nullptr;
  png_infop png_info_ = nullptr;
  Palette palette_;
  bool has_palette_ = false;
  ImageFileInfo info_;
  ColourFacts colours_;
};

void PngDecoder::ReadBytes(png_structp png, png_bytep to, size_t count) {
  PngDecoder& decoder = *static_cast<PngDecoder*>(png_get_io_ptr(png));
  size_t done = 0;
  decoder.calls_.Guard([&] { done = decoder.file_.read(decoder.offset_, {to, count}); });
  if (done != count) png_error(png, "the file ends too early");
  decoder.offset_ += count;
}

// Calls `calls`. kInput if libpng reported an error.
template <class Calls>
Result<void> PngDecoder::Run(const Calls& calls) {
  if (calls_.Run(calls)) return {};
  return InputError(fmt::format("{}: truncated or damaged: {}", file_.name, calls_.message()));
}

Result<void> PngDecoder::CreateStructs() {
  LF_RETURN_IF_ERROR(Run([&] {
    png_ = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &calls_, PngCalls::OnError, OnWarning,
                                    &calls_, PngCalls::Allocate, PngCalls::Free);
    if (png_ != nullptr) png_info_ = png_create_info_struct(png_);
  }));
  if (png_info_ == nullptr) throw std::bad_alloc();
  return {};
}

Result<void> PngDecoder::Open() {
  LF_RETURN_IF_ERROR(CreateStructs());
  LF_RETURN_IF_ERROR(Run([&] {
    png_set_read_fn(png_, this, ReadBytes);
    // CheckPictureSize() limits width and height.
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_chunk_malloc_max(png_, kMostTextBytes);
    png_set_chunk_cache_max(png_, kMostTexts);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    constexpr png_byte kRead[] = "eXIf\0iCCP\0sRGB\0tEXt\0zTXt";
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_AS_DEFAULT, kRead, 5);
    png_read_info(png_, png_info_);
  }));
  ReadHeader();
  return CheckPictureSize(info_.width, info_.height, info_.channels, file_.name);
}

void PngDecoder::ReadHeader() {
  has_palette_ = png_get_color_type(png_, png_info_) == PNG_COLOR_TYPE_PALETTE;
  const bool has_transparency = png_get_valid(png_, png_info_, PNG_INFO_tRNS) != 0;
  if (has_palette_) ReadPalette();
  info_.width = static_cast<int>(png_get_image_width(png_, png_info_));
  info_.height = static_cast<int>(png_get_image_height(png_, png_info_));
  info_.channels =
      (has_palette_ ? 3 : png_get_channels(png_, png_info_)) + (has_transparency ? 1 : 0);
  info_.bits = png_get_bit_depth(png_, png_info_) == 16 ? 16 : 8;
  info_.channel_names = info_.channels < 3 ? std::vector<std::string>{"Y", "A"}
                                           : std::vector<std::string>{"R", "G", "B", "A"};
  if (info_.channels % 2 == 1) info_.channel_names.pop_back();
  info_.orientation = OrientationOf(png_, png_info_);
  colours_.type = TypeOfValues(info_);
  colours_.is_srgb = png_get_valid(png_, png_info_, PNG_INFO_sRGB) != 0;
  colours_.frames_per_second = FrameRateOf(png_, png_info_);
  colours_.camera = StatedCameraOf([this](const char* key) { return Text(key); });
  colours_.first_frame = ParseFrameNumber(Text(kFirstFrameText));
}

void PngDecoder::ReadPalette() {
  png_colorp colours = nullptr;
  png_get_PLTE(png_, png_info_, &colours, &palette_.size);
  png_bytep alphas = nullptr;
  int alpha_count = 0;
  png_get_tRNS(png_, png_info_, &alphas, &alpha_count, nullptr);
  for (int i = 0; i < palette_.size; ++i) {
    const uint8_t alpha = i < alpha_count ? alphas[i] : uint8_t{255};
    palette_.colours[i] = {colours[i].red, colours[i].green, colours[i].blue, alpha};
  }
}

// Makes libpng return values of 8 or 16 bits, or the indices of a palette as bytes. (libpng could
// replace the indices, but it would guess the colours that a palette lacks.) Returns the number of
// passes over the rows, which is 1 if the file is not interlaced.
int PngDecoder::SetTransforms() {
  if (has_palette_)
    png_set_packing(png_);
  else
    png_set_expand(png_);
  if (std::endian::native == std::endian::little) png_set_swap(png_);
  const int passes = png_set_interlace_handling(png_);
  png_read_update_info(png_, png_info_);
  return passes;
}

template <class T>
Result<void> PngDecoder::ReadRows(Image<T>* image) {
  const size_t index_begin =
      has_palette_ ? static_cast<size_t>(info_.width) * (info_.channels - 1) : 0;
  return Run([&] {
    const int passes = SetTransforms();
    LF_CHECK(png_get_rowbytes(png_, png_info_) ==
             (image->size_bytes() / info_.height) - index_begin);
    for (int pass = 0; pass < passes; ++pass)
      for (int y = 0; y < info_.height; ++y)
        png_read_row(png_, reinterpret_cast<png_bytep>(image->row(y) + index_begin), nullptr);
    png_read_end(png_, nullptr);
  });
}

Result<void> PngDecoder::ReplaceAllIndices(Image<uint8_t>* image) const {
  for (int y = 0; y < info_.height; ++y) {
    const int missing = ReplaceIndices(palette_, info_.width, info_.channels, image->row(y));
    if (missing >= 0)
      return InputError(
          fmt::format("{}: truncated or damaged: row {} uses colour {} of the palette, which has "
                      "only {} colours",
                      file_.name, y, missing, palette_.size));
  }
  return {};
}

Result<void> PngDecoder::Read(StoredImage* image) {
  const auto [width, height, channels] = std::tuple(info_.width, info_.height, info_.channels);
  if (info_.bits == 16) return ReadRows(&Resized<uint16_t>(width, height, channels, image));
  Image<uint8_t>& bytes = Resized<uint8_t>(width, height, channels, image);
  LF_RETURN_IF_ERROR(ReadRows(&bytes));
  return has_palette_ ? ReplaceAllIndices(&bytes) : Result<void>();
}

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenPng(const FileBytes& file) {
  return Opened<PngDecoder>(file);
}

}  // namespace lf
