// SPDX-License-Identifier: Apache-2.0
// Reads BMP files without compression: palettes, 16, 24 and 32 bits for a pixel. The format is that
// of Microsoft's BITMAPINFOHEADER, BITMAPV4HEADER and BITMAPV5HEADER.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lf/pixels/files/rows_decoder.h"

namespace lf {
namespace {

constexpr uint64_t kFileHeadBytes = 14;
constexpr uint64_t kCoreBytes = 12, kInfoBytes = 40, kAlphaMaskBytes = 56, kV5Bytes = 124;

// Returns the number of `count` bytes at `offset`, the least significant byte first; none beyond
// the end of the file.
std::optional<uint32_t> NumberAt(const FileBytes& file, uint64_t offset, size_t count) {
  std::array<uint8_t, 4> bytes = {};
  if (file.read(offset, std::span(bytes).first(count)) != count) return std::nullopt;
  return uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8 | uint32_t{bytes[2]} << 16 |
         uint32_t{bytes[3]} << 24;
}

// A channel within a pixel of 16 or 32 bits, and its values scaled to 8 bits.
struct BitField {
  int shift = 0;
  uint32_t most = 0;  // 0: the channel is not there
  uint8_t Of(uint32_t pixel) const {
    return static_cast<uint8_t>(((pixel >> shift & most) * 255 + most / 2) / most);
  }
};

struct BmpHead {
  int64_t width = 0, height = 0;
  int bits = 0;  // of a pixel
  bool is_top_down = false;
  std::vector<std::array<uint8_t, 3>> palette;  // R, G, B
  std::array<BitField, 4> fields;               // R, G, B, A of 16 and 32 bits
  uint64_t pixels_begin = 0;
  uint64_t profile_begin = 0, profile_bytes = 0;
};

// Returns none if the bits of the mask do not lie side by side, or are more than 8.
std::optional<BitField> FieldOf(uint32_t mask) {
  if (mask == 0) return BitField();
  const int shift = std::countr_zero(mask);
  const uint32_t most = mask >> shift;
  if ((most & (most + 1)) != 0 || most > 255) return std::nullopt;
  return BitField{shift, most};
}

class BmpParser {
 public:
  explicit BmpParser(const FileBytes& file) : file_(file) {}

  Result<BmpHead> Parse() {
    const auto begin = NumberAt(file_, 10, 4), head_bytes = NumberAt(file_, kFileHeadBytes, 4);
    if (!begin || !head_bytes || (*head_bytes != kCoreBytes && *head_bytes < kInfoBytes))
      return Damaged();
    head_.pixels_begin = *begin;
    head_bytes_ = *head_bytes;
    LF_RETURN_IF_ERROR(ParseSize());
    if (head_.bits <= 8) LF_RETURN_IF_ERROR(ParsePalette());
    if (head_.bits == 16 || head_.bits == 32) LF_RETURN_IF_ERROR(ParseFields());
    ParseProfile();
    return std::move(head_);
  }

 private:
  static constexpr uint32_t kPlain = 0, kRle8 = 1, kRle4 = 2, kBitFields = 3, kAlphaBitFields = 6;

  Error Damaged() const {
    return InputError(fmt::format("{}: BMP file with a damaged or truncated head", file_.name));
  }

  Result<void> ParseSize() {
    const bool is_core = head_bytes_ == kCoreBytes;
    const uint64_t at = kFileHeadBytes + 4;
    const auto width = NumberAt(file_, at, is_core ? 2 : 4);
    const auto height = NumberAt(file_, is_core ? at + 2 : at + 4, is_core ? 2 : 4);
    const auto bits = NumberAt(file_, is_core ? at + 6 : at + 10, 2);
    const auto compression = is_core ? kPlain : NumberAt(file_, at + 12, 4);
    if (!width || !height || !bits || !compression) return Damaged();
    head_.width = is_core ? int64_t{*width} : int64_t{static_cast<int32_t>(*width)};
    head_.height = is_core ? int64_t{*height} : int64_t{static_cast<int32_t>(*height)};
    head_.is_top_down = head_.height < 0;
    head_.height = std::abs(head_.height);
    head_.bits = static_cast<int>(*bits);
    compression_ = *compression;
    if (compression_ == kRle8 || compression_ == kRle4)
      return InputError(fmt::format(
          "{}: is a BMP file with run-length compression, which is not read: save it without "
          "compression, or as PNG",
          file_.name));
    const bool has_fields = compression_ == kBitFields || compression_ == kAlphaBitFields;
    constexpr int kBits[] = {1, 4, 8, 16, 24, 32};
    if (std::find(std::begin(kBits), std::end(kBits), head_.bits) == std::end(kBits) ||
        (compression_ != kPlain && !(has_fields && (head_.bits == 16 || head_.bits == 32))))
      return InputError(fmt::format(
          "{}: is a BMP file of {} bits for a pixel and of compression {}, which is not read: save "
          "it as PNG",
          file_.name, head_.bits, compression_));
    return {};
  }

  Result<void> ParsePalette() {
    const bool is_core = head_bytes_ == kCoreBytes;
    const size_t most = size_t{1} << head_.bits, entry_bytes = is_core ? 3 : 4;
    const auto stated = is_core ? 0 : NumberAt(file_, kFileHeadBytes + 32, 4);
    if (!stated) return Damaged();
    const size_t count = *stated == 0 ? most : std::min<size_t>(*stated, most);
    std::vector<uint8_t> bytes(count * entry_bytes);
    if (file_.read(kFileHeadBytes + head_bytes_, bytes) != bytes.size()) return Damaged();
    for (size_t i = 0; i < count; ++i) {
      const uint8_t* const bgr = &bytes[i * entry_bytes];
      head_.palette.push_back({bgr[2], bgr[1], bgr[0]});
    }
    return {};
  }

  Result<void> ParseFields() {
    std::array<uint32_t, 4> masks = {0x7c00, 0x3e0, 0x1f, 0};
    if (head_.bits == 32) masks = {0xff0000, 0xff00, 0xff, 0};
    if (compression_ != kPlain) {
      const bool has_alpha = head_bytes_ >= kAlphaMaskBytes || compression_ == kAlphaBitFields;
      for (size_t c = 0; c < (has_alpha ? 4U : 3U); ++c) {
        const auto mask = NumberAt(file_, kFileHeadBytes + kInfoBytes + 4 * c, 4);
        if (!mask) return Damaged();
        masks[c] = *mask;
      }
    }
    for (size_t c = 0; c < 4; ++c) {
      const std::optional<BitField> field = FieldOf(masks[c]);
      if (!field || (c < 3 && field->most == 0))
        return InputError(fmt::format(
            "{}: is a BMP file whose colours have the masks {:#x}, {:#x} and {:#x}: expected up to "
            "8 bits for each; save it as PNG",
            file_.name, masks[0], masks[1], masks[2]));
      head_.fields[c] = *field;
    }
    return {};
  }

  // A profile within the file (bV5CSType is "MBED").
  void ParseProfile() {
    constexpr uint32_t kEmbedded = 0x4d424544, kMostBytes = 1 << 24;
    if (head_bytes_ < kV5Bytes) return;
    const auto kind = NumberAt(file_, kFileHeadBytes + 56, 4);
    const auto begin = NumberAt(file_, kFileHeadBytes + 112, 4);
    const auto bytes = NumberAt(file_, kFileHeadBytes + 116, 4);
    if (kind != kEmbedded || !begin || !bytes || *bytes > kMostBytes) return;
    head_.profile_begin = kFileHeadBytes + *begin;
    head_.profile_bytes = *bytes;
  }

  const FileBytes& file_;
  uint64_t head_bytes_ = 0;
  uint32_t compression_ = 0;
  BmpHead head_;
};

class BmpDecoder : public RowsDecoder {
 public:
  BmpDecoder(const FileBytes& file, BmpHead head) : RowsDecoder(file), head_(std::move(head)) {
    const auto is_grey = [](const std::array<uint8_t, 3>& c) {
      return c[0] == c[1] && c[1] == c[2];
    };
    const bool has_grey_palette =
        !head_.palette.empty() && std::all_of(head_.palette.begin(), head_.palette.end(), is_grey);
    info_.width = static_cast<int>(head_.width);
    info_.height = static_cast<int>(head_.height);
    info_.channels = has_grey_palette ? 1 : head_.fields[3].most != 0 ? 4 : 3;
    info_.bits = 8;
    info_.channel_names = {"R", "G", "B", "A"};
    if (has_grey_palette) info_.channel_names = {"Y"};
    info_.channel_names.resize(static_cast<size_t>(info_.channels));
    // Rows end at multiples of 32 bits.
    rows_ = {head_.pixels_begin,
             (static_cast<uint64_t>(head_.width) * static_cast<uint64_t>(head_.bits) + 31) / 32 * 4,
             info_.height, !head_.is_top_down};
  }

  std::string IccProfile() const override {
    std::string profile(head_.profile_bytes, '\0');
    const size_t count = file_.read(head_.profile_begin,
                                    {reinterpret_cast<uint8_t*>(profile.data()), profile.size()});
    return count == profile.size() ? profile : "";
  }

  Result<PixelRect> ReadRect(const PixelRect& rect, StoredImage* image) override {
    Image<uint8_t>& pixels = Resized<uint8_t>(rect.width(), rect.height(), info_.channels, image);
    uint32_t largest_index = 0;
    LF_RETURN_IF_ERROR(
        ForEachRowInFile(file_, rows_, rect.y_begin, rect.y_end, [&](const uint8_t* row, int y) {
          uint8_t* out = pixels.row(y - rect.y_begin);
          for (int x = rect.x_begin; x < rect.x_end; ++x, out += info_.channels)
            largest_index = std::max(largest_index, Convert(row, x, out));
        }));
    if (head_.palette.empty() || largest_index < head_.palette.size()) return rect;
    return InputError(fmt::format("{}: damaged: uses colour {} of a palette of {} colours",
                                  file_.name, largest_index, head_.palette.size()));
  }

 private:
  // Writes the channels of a pixel. Returns its index in the palette, if there is one.
  uint32_t Convert(const uint8_t* row, int x, uint8_t* out) const {
    const auto at = static_cast<size_t>(x);
    if (!head_.palette.empty()) {
      const auto bits = static_cast<size_t>(head_.bits);
      const uint32_t index =
          row[at * bits / 8] >> (8 - bits - at * bits % 8) & ((uint32_t{1} << bits) - 1);
      if (index < head_.palette.size())
        std::copy_n(head_.palette[index].begin(), info_.channels, out);
      return index;
    }
    if (head_.bits == 24) {
      for (size_t c = 0; c < 3; ++c) out[c] = row[3 * at + 2 - c];
      return 0;
    }
    const uint8_t* const bytes = row + at * static_cast<size_t>(head_.bits / 8);
    uint32_t pixel = uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8;
    if (head_.bits == 32) pixel |= uint32_t{bytes[2]} << 16 | uint32_t{bytes[3]} << 24;
    for (int c = 0; c < info_.channels; ++c)
      out[c] = head_.fields[static_cast<size_t>(c)].Of(pixel);
    return 0;
  }

  const BmpHead head_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenBmp(const FileBytes& file) {
  LF_ASSIGN_OR_RETURN(BmpHead head, BmpParser(file).Parse());
  LF_RETURN_IF_ERROR(CheckPictureSize(head.width, head.height, 4, file.name));
  auto decoder = std::make_unique<BmpDecoder>(file, std::move(head));
  LF_RETURN_IF_ERROR(CheckRowsAreThere(file, decoder->rows(), "BMP"));
  return std::unique_ptr<PictureDecoder>(std::move(decoder));
}

}  // namespace lf
