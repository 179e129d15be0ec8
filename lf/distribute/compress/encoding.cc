// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/encoding.h"

#include <fmt/format.h>

#include "lf/storage/packed/packed_store_file.h"

namespace lf {

std::string NameOf(const Encoding& encoding, const ThresholdFactors& factors) {
  const CodecSettings& settings = encoding.settings;
  const char* const kept = encoding.files == KeepFiles::kSmaller
                               ? ", or the image file if it is smaller"
                           : encoding.files == KeepFiles::kAll ? ", or the image file"
                                                               : "";
  const char* const entropy = settings.entropy == Entropy::kContexts ? ", coded by contexts" : "";
  const char* const groups = encoding.in_groups ? ", in groups" : "";
  switch (settings.profile) {
    case CodecProfile::kThesis:
      return fmt::format("thesis, levels {}, threshold {}, quantizer {}", settings.levels,
                         settings.threshold, settings.quantizer);
    case CodecProfile::kDefault:
      return fmt::format("default, levels {}, threshold {}{}{}{}{}", settings.levels,
                         settings.threshold, factors.Words(), entropy, groups, kept);
    case CodecProfile::kLossless:
      break;
  }
  return fmt::format("{}, levels {}{}{}{}", kLosslessCodec, settings.levels, entropy, groups, kept);
}

}  // namespace lf
