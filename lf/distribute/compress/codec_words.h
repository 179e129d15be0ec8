// SPDX-License-Identifier: Apache-2.0
// How LF images are encoded, in the words of lfcompressor's options.
#pragma once

#include <string>

#include "lf/core/result.h"
#include "lf/distribute/compress/compress.h"

namespace lf {

// Each member has the meaning and the default of the option of lfcompressor with this name.
struct CodecWords {
  // default, thesis, lossless, recorded, group, group-lossless or auto
  std::string profile = "default";
  std::string quantizer = "8bit";
  std::string entropy = "auto";  // auto, packed or contexts
  int levels = 0;                // 0: the default of the profile
  double threshold = -1;         // below 0: the default of the profile
  double target_psnr = 0;        // in dB; 0: the threshold is not searched for
  bool reencode = false;         // true: no image file is kept
  bool quality_by_use = false;
  // none, or joint: RGB LF images are made of mosaics (DemosaickedJointly()), which the caller does
  std::string demosaic = "none";

  friend bool operator==(const CodecWords&, const CodecWords&) = default;
};

// Sets options->codec, options->files, options->prediction,
// options->group_entropy and options->target_psnr_db. kUsage:
// words that do not exist, or that contradict each other.
Result<void> SetCodec(const CodecWords& words, CompressOptions* options);

}  // namespace lf
