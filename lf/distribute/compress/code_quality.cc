// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/code_quality.h"

#include <cmath>

#include "lf/core/check.h"

namespace lf {

double CodeError::PsnrDb() const {
  if (squared == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(static_cast<double>(count) / squared);
}

double GreyStep(const RadianceEncoding& encoding, StoredValues values) {
  if (values == StoredValues::kHalf) return 16;
  const int bits = values == StoredValues::kUint8 ? 8 : 16;
  const double white = encoding.white_level.value_or((1 << bits) - 1);
  return LevelsFit(encoding, bits) ? (white - encoding.black_level) / 255 : 1;
}

CodeError ErrorOf(const CodecPixels& coded, const DecodedPart& decoded, double grey_step) {
  CodeError error;
  std::visit(
      [&]<class Pixel>(const Image<Pixel>& image) {
        const auto& other = std::get<Image<Pixel>>(decoded.pixels);
        const PixelRect& rect = decoded.rect;
        LF_CHECK(other.channels() == image.channels() && other.width() == rect.width() &&
                 other.height() == rect.height() && rect.x_begin >= 0 && rect.y_begin >= 0 &&
                 rect.x_end <= image.width() && rect.y_end <= image.height());
        const size_t row_values = static_cast<size_t>(rect.width()) * image.channels();
        // Adds up integers, because their sum is exact: it is the same in whatever order a compiler
        // adds the squares.
        uint64_t sum = 0;
        for (int y = 0; y < rect.height(); ++y) {
          const Pixel* const original =
              image.row(rect.y_begin + y) + static_cast<size_t>(rect.x_begin) * image.channels();
          const Pixel* const row = other.row(y);
          for (size_t i = 0; i < row_values; ++i) {
            const int64_t difference = int64_t{original[i]} - row[i];
            sum += static_cast<uint64_t>(difference * difference);
          }
        }
        const double white = 255 * grey_step;
        error.squared = static_cast<double>(sum) / (white * white);
        error.count = other.pixels().size();
      },
      coded);
  return error;
}

}  // namespace lf
