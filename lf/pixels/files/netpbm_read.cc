// SPDX-License-Identifier: Apache-2.0
// Reads the files of Netpbm: PBM, PGM, PPM (plain and raw) and PAM. The format is that of
// https://netpbm.sourceforge.net/doc/ppm.html and pam.html.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/pixels/files/rows_decoder.h"
#include "lf/pixels/files/text_head.h"

namespace lf {
namespace {

constexpr size_t kMostHeadBytes = 65536;  // comments included
constexpr int64_t kMostMaxval = 65535;
constexpr int64_t kMostSide = int64_t{1} << 31;

// The values of a picture. Plain files write them as decimal numbers.
struct NetpbmHead {
  int64_t width = 0, height = 0, channels = 1;
  int64_t maxval = 1;    // the value of white
  bool is_bits = false;  // PBM: one bit for each pixel, 1 is black
  bool is_plain = false;
  uint64_t pixels_begin = 0;
};

std::optional<NetpbmHead> ParsePam(TextHead* words) {
  NetpbmHead head;
  head.channels = head.maxval = 0;
  while (true) {
    const std::string_view key = words->Word();
    if (key.empty()) return std::nullopt;
    if (key == "ENDHDR") break;
    if (key == "TUPLTYPE") {
      words->Line();  // the number of channels tells enough
      continue;
    }
    int64_t* const number = key == "WIDTH"    ? &head.width
                            : key == "HEIGHT" ? &head.height
                            : key == "DEPTH"  ? &head.channels
                            : key == "MAXVAL" ? &head.maxval
                                              : nullptr;
    if (number == nullptr) return std::nullopt;
    const std::optional<int64_t> value = words->Integer(kMostSide);
    if (!value) return std::nullopt;
    *number = *value;
  }
  if (head.channels < 1 || head.channels > 4) return std::nullopt;
  return head;
}

// Returns none if the head is damaged.
std::optional<NetpbmHead> ParseHead(std::string_view start) {
  TextHead words(start);
  const std::string_view magic = words.Word();
  const char kind = magic[1];
  NetpbmHead head;
  if (kind == '7') {
    const std::optional<NetpbmHead> pam = ParsePam(&words);
    if (!pam) return std::nullopt;
    head = *pam;
  } else {
    const std::optional<int64_t> width = words.Integer(kMostSide),
                                 height = words.Integer(kMostSide);
    if (!width || !height) return std::nullopt;
    head.width = *width;
    head.height = *height;
    head.is_plain = kind <= '3';
    head.is_bits = kind == '1' || kind == '4';
    head.channels = kind == '3' || kind == '6' ? 3 : 1;
    if (!head.is_bits) {
      const std::optional<int64_t> maxval = words.Integer(kMostMaxval);
      if (!maxval) return std::nullopt;
      head.maxval = *maxval;
    }
  }
  if (head.maxval < 1 || head.maxval > kMostMaxval || words.position() >= start.size())
    return std::nullopt;
  head.pixels_begin = words.position() + 1;  // behind a single blank
  return head;
}

class NetpbmDecoder : public RowsDecoder {
 public:
  NetpbmDecoder(const FileBytes& file, const NetpbmHead& head) : RowsDecoder(file), head_(head) {
    info_.width = static_cast<int>(head.width);
    info_.height = static_cast<int>(head.height);
    info_.channels = static_cast<int>(head.channels);
    info_.bits = head.maxval > 255 ? 16 : 8;
    info_.channel_names = info_.channels < 3 ? std::vector<std::string>{"Y", "A"}
                                             : std::vector<std::string>{"R", "G", "B", "A"};
    if (info_.channels % 2 == 1) info_.channel_names.pop_back();
    const auto row_values = static_cast<uint64_t>(head.width * head.channels);
    rows_ = {
        head.pixels_begin,
        head.is_bits ? (row_values + 7) / 8 : row_values * static_cast<uint64_t>(info_.bits / 8),
        info_.height, false};
  }

  bool has_rows_on_disk() const override { return !head_.is_plain; }

  Result<PixelRect> ReadRect(const PixelRect& rect, StoredImage* image) override {
    if (info_.bits == 8) return ReadValues<uint8_t>(rect, image);
    return ReadValues<uint16_t>(rect, image);
  }

 private:
  Error DamagedValue(int64_t value) const {
    return InputError(fmt::format("{}: damaged: has the value {}, but states that {} is white",
                                  file_.name, value, head_.maxval));
  }

  // Returns the value that is stored for each value of the file: scaled to the full range, rounded.
  template <class T>
  std::vector<T> FullRange() const {
    std::vector<T> table(static_cast<size_t>(head_.maxval) + 1);
    for (int64_t value = 0; value <= head_.maxval; ++value)
      table[static_cast<size_t>(value)] =
          static_cast<T>((value * std::numeric_limits<T>::max() + head_.maxval / 2) / head_.maxval);
    return table;
  }

  template <class T>
  Result<PixelRect> ReadValues(const PixelRect& rect, StoredImage* image) {
    if (head_.is_plain) {
      LF_RETURN_IF_ERROR(ReadPlain(&Resized<T>(info_.width, info_.height, info_.channels, image)));
      return PixelRect{0, 0, info_.width, info_.height};
    }
    Image<T>& pixels = Resized<T>(rect.width(), rect.height(), info_.channels, image);
    const std::vector<T> table = FullRange<T>();
    int64_t largest = 0;
    LF_RETURN_IF_ERROR(
        ForEachRowInFile(file_, rows_, rect.y_begin, rect.y_end, [&](const uint8_t* row, int y) {
          T* out = pixels.row(y - rect.y_begin);
          for (int x = rect.x_begin; head_.is_bits && x < rect.x_end; ++x)
            *out++ = (row[x / 8] >> (7 - x % 8) & 1) != 0 ? 0 : table.back();
          if (head_.is_bits) return;
          const size_t begin = static_cast<size_t>(rect.x_begin) * info_.channels;
          const size_t end = static_cast<size_t>(rect.x_end) * info_.channels;
          for (size_t i = begin; i < end; ++i) {
            const int64_t value = sizeof(T) == 1 ? row[i] : row[2 * i] << 8 | row[2 * i + 1];
            largest = std::max(largest, value);
            *out++ = table[static_cast<size_t>(std::min(value, head_.maxval))];
          }
        }));
    if (largest > head_.maxval) return DamagedValue(largest);
    return rect;
  }

  template <class T>
  Result<void> ReadPlain(Image<T>* pixels) {
    std::string storage;
    TextHead words(ContentOf(file_, &storage).substr(head_.pixels_begin));
    const std::vector<T> table = FullRange<T>();
    std::string_view bits;  // digits of PBM need no blanks between them
    for (T& pixel : pixels->pixels()) {
      if (head_.is_bits) {
        if (bits.empty()) bits = words.Word();
        if (bits.empty() || (bits[0] != '0' && bits[0] != '1'))
          return InputError(fmt::format("{}: truncated or damaged: expected {} pixels, 0 or 1",
                                        file_.name, pixels->pixels().size()));
        pixel = bits[0] == '1' ? 0 : table.back();
        bits.remove_prefix(1);
        continue;
      }
      const std::optional<int64_t> value = words.Integer(kMostMaxval);
      if (!value)
        return InputError(fmt::format("{}: truncated or damaged: expected {} numbers of pixels",
                                      file_.name, pixels->pixels().size()));
      if (*value > head_.maxval) return DamagedValue(*value);
      pixel = table[static_cast<size_t>(*value)];
    }
    return {};
  }

  const NetpbmHead head_;
};

}  // namespace

Result<std::unique_ptr<PictureDecoder>> OpenNetpbm(const FileBytes& file) {
  const std::optional<NetpbmHead> head = ParseHead(StartOf(file, kMostHeadBytes));
  if (!head)
    return InputError(fmt::format(
        "{}: the head of the Netpbm file (PPM, PGM, PBM or PAM) is damaged: expected width, height "
        "and, except in PBM, the value of white from 1 to 65535",
        file.name));
  LF_RETURN_IF_ERROR(CheckPictureSize(head->width, head->height, head->channels, file.name));
  auto decoder = std::make_unique<NetpbmDecoder>(file, *head);
  // A number and a blank take at least two bytes in a plain file, a bit one.
  const auto values = static_cast<uint64_t>(head->width * head->height * head->channels);
  if (head->is_plain && values / 2 > file.size_bytes)
    return InputError(fmt::format("{}: Netpbm file is truncated: claims {} values in {} bytes",
                                  file.name, values, file.size_bytes));
  if (!head->is_plain) LF_RETURN_IF_ERROR(CheckRowsAreThere(file, decoder->rows(), "Netpbm"));
  return std::unique_ptr<PictureDecoder>(std::move(decoder));
}

}  // namespace lf
