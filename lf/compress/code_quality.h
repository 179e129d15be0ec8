// How far decoded pixels are from those that were coded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "lf/capture/radiance.h"
#include "lf/codec/lf_image_codec.h"
#include "lf/core/geometry.h"
#include "lf/packed/packed_store_file.h"

namespace lf {

// Sums of many images add up.
struct CodeError {
  double squared = 0;  // of differences, as parts of what white is above black
  uint64_t count = 0;  // of values

  CodeError& operator+=(const CodeError& other) {
    squared += other.squared;
    count += other.count;
    return *this;
  }
  // Of all values together; infinite without a difference.
  double PsnrDb() const;
};

// How many stored values a grey step is: the difference of two of 256 greys between black and
// white. Of 8 bits 1, of 16 bits 257, unless levels are stated. Half floats are taken by their bit
// patterns, of which 1024 are a factor of two in radiance: 16, about one part in a hundred.
double GreyStep(const RadianceEncoding& encoding, StoredValues values);

// `decoded` must be all of the image.
CodeError ErrorOf(const CodecPixels& coded, const DecodedPart& decoded, double grey_step);

}  // namespace lf
