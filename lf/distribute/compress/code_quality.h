// SPDX-License-Identifier: Apache-2.0
// Measures the difference between decoded pixels and the original ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "lf/core/geometry.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// The error of one image. Errors of several images can be added.
struct CodeError {
  double squared = 0;  // sum over all values of (difference / range from black to white)^2
  uint64_t count = 0;  // number of these values

  CodeError& operator+=(const CodeError& other) {
    squared += other.squared;
    count += other.count;
    return *this;
  }
  // Returns the mean of the squares; 0 if there are no values.
  double Mean() const { return count == 0 ? 0 : squared / static_cast<double>(count); }
  // Returns the PSNR of all values together; infinite if there is no difference.
  double PsnrDb() const;
};

// Returns the size of a grey step in stored values: the range from black to white has 255 steps. A
// step is 1 for 8 bits and 257 for 16 bits, unless the encoding states other levels of black and
// white; it is 1 if these levels do not fit into the number of bits. Half floats are measured as
// integers with the same bits, because 1024 such integers are a factor of two in radiance; their
// step is 16, which is about 1 % of the radiance.
double GreyStep(const RadianceEncoding& encoding, StoredValues values);

// Returns the error of a part of one image: the difference of `decoded` from the same pixels of the
// original `coded`.
CodeError ErrorOf(const CodecPixels& coded, const DecodedPart& decoded, double grey_step);

}  // namespace lf
