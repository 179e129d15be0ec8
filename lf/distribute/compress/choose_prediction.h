// SPDX-License-Identifier: Apache-2.0
// Chooses by a sample of LF images how a light field takes the fewest bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/distribute/compress/image_use.h"
#include "lf/pixels/codec/lf_image_codec.h"

namespace lf {

// Sizes of a sample of LF images, encoded in different ways.
struct SampledBytes {
  size_t image_count = 0;
  size_t file_count = 0;  // LF images whose files are at most as large as their encoded images
  // Each LF image encoded by itself, with the coder of groups, or its file if that is smaller.
  uint64_t alone = 0;
  uint64_t in_groups = 0;  // predicted from others of their groups, where that is worth it

  // Returns true if groups save a tenth of the bytes.
  bool GroupsAreBetter() const;
  // Returns true if all files are smaller.
  bool FilesAreBetter() const { return !GroupsAreBetter() && file_count == image_count; }
};

// Encodes the LF images of a few groups that are spread over the light field. The result does not
// depend on the number of threads. kInput: no LF image of the sample can be read. kInterrupted:
// is_interrupted() returned true.
//   settings  profile kDefault or kLossless; the threshold is in grey steps
//   progress  called with the number of LF images that are encoded, from 0, and that of the sample
Result<SampledBytes> SampleBytes(const CompressSource& source, const CodecSettings& settings,
                                 const ThresholdFactors& factors, ThreadPool& pool,
                                 const std::function<bool()>& is_interrupted,
                                 const std::function<void(size_t done, size_t total)>& progress);

}  // namespace lf
