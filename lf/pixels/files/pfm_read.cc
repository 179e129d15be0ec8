// SPDX-License-Identifier: Apache-2.0
// Reads PFM files: floats of one channel ("Pf") or three ("PF"), from the lowest row on. The format
// is that of http://www.pauldebevec.com/Research/HDR/PFM/.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/parse_number.h"
#include "lf/pixels/files/rows_decoder.h"
#include "lf/pixels/files/text_head.h"

namespace lf {
namespace {

class PfmDecoder : public RowsDecoder {
 public:
  PfmDecoder(const FileBytes& file, const ImageFileInfo& info, uint64_t begin, bool is_big_endian)
      : RowsDecoder(file), is_big_endian_(is_big_endian) {
    info_ = info;
    const auto row_values =
        static_cast<uint64_t>(info.width) * static_cast<uint64_t>(info.channels);
    rows_ = {begin, row_values * sizeof(float), info.height, true};
  }

  Result<PixelRect> ReadRect(const PixelRect& rect, StoredImage* image) override {
    Image<float>& pixels = Resized<float>(rect.width(), rect.height(), info_.channels, image);
    const auto channels = static_cast<size_t>(info_.channels);
    const size_t begin = static_cast<size_t>(rect.x_begin) * channels;
    const size_t count = static_cast<size_t>(rect.width()) * channels;
    const bool swaps = is_big_endian_ != (std::endian::native == std::endian::big);
    LF_RETURN_IF_ERROR(
        ForEachRowInFile(file_, rows_, rect.y_begin, rect.y_end, [&](const uint8_t* row, int y) {
          float* const out = pixels.row(y - rect.y_begin);
          for (size_t i = 0; i < count; ++i) {
            uint32_t bits = 0;
            std::memcpy(&bits, row + (begin + i) * sizeof(float), sizeof(float));
            out[i] = std::bit_cast<float>(swaps ? __builtin_bswap32(bits) : bits);
          }
        }));
    return rect;
  }

 private:
  const bool is_big_endian_;
};

}  // namespace

// The sign of the scale states the order of bytes. Its size is not used, as by most programs.
Result<std::unique_ptr<PictureDecoder>> OpenPfm(const FileBytes& file) {
  constexpr size_t kMostPfmHeadBytes = 4096;
  constexpr int64_t kMostPfmSide = int64_t{1} << 31;
  const std::string start = StartOf(file, kMostPfmHeadBytes);
  TextHead words(start);
  const bool is_grey = words.Word() == "Pf";
  const std::optional<int64_t> width = words.Integer(kMostPfmSide),
                               height = words.Integer(kMostPfmSide);
  const std::optional<double> scale = ParseNumber(words.Word());
  if (!width || !height || !scale || *scale == 0 || words.position() >= start.size())
    return InputError(fmt::format(
        "{}: the head of the PFM file is damaged: expected width, height and a scale other than 0",
        file.name));
  LF_RETURN_IF_ERROR(CheckPictureSize(*width, *height, is_grey ? 1 : 3, file.name));
  ImageFileInfo info;
  info.width = static_cast<int>(*width);
  info.height = static_cast<int>(*height);
  info.channels = is_grey ? 1 : 3;
  info.bits = 32;
  info.is_float = true;
  info.channel_names =
      is_grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  auto decoder = std::make_unique<PfmDecoder>(file, info, words.position() + 1, *scale > 0);
  LF_RETURN_IF_ERROR(CheckRowsAreThere(file, decoder->rows(), "PFM"));
  return std::unique_ptr<PictureDecoder>(std::move(decoder));
}

}  // namespace lf
