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
        LF_CHECK(other.pixels().size() == image.pixels().size());
        // Adds up integers, because their sum is exact: it is the same in whatever order a compiler
        // adds the squares.
        uint64_t sum = 0;
        for (size_t i = 0; i < image.pixels().size(); ++i) {
          const int64_t difference = int64_t{image.pixels()[i]} - other.pixels()[i];
          sum += static_cast<uint64_t>(difference * difference);
        }
        const double white = 255 * grey_step;
        error.squared = static_cast<double>(sum) / (white * white);
        error.count = image.pixels().size();
      },
      coded);
  return error;
}

}  // namespace lf
