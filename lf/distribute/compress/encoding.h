// SPDX-License-Identifier: Apache-2.0
// How LF images are encoded.
#pragma once

#include <cstddef>
#include <string>

#include "lf/distribute/compress/image_use.h"
#include "lf/distribute/compress/keep_files.h"
#include "lf/pixels/codec/lf_image_codec.h"

namespace lf {

struct Encoding {
  CodecSettings settings;  // the threshold is in grey steps
  KeepFiles files = KeepFiles::kNone;
  bool in_groups = false;  // true: LF images are predicted from others of their group
};

// Returns the encoding in words, as a store records it. A store is resumed or verified only with
// equal words. Words of an encoding that loses nothing begin with kLosslessCodec.
//   factors  factors of the threshold of settings
std::string NameOf(const Encoding& encoding, const ThresholdFactors& factors = {});

}  // namespace lf
