// The threshold that gives a quality. Internal to compress.
#pragma once

#include <functional>

#include "lf/codec/lf_image_codec.h"
#include "lf/compress/compress_source.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"

namespace lf {

// In grey steps: the largest of some, a twentieth apart, at which LF images spread over the light
// field have at least `psnr_db` together. The same for any number of threads.
// kUsage: the profile has none that reaches it, or no threshold; kInput: none of them can be read;
// kInterrupted.
Result<double> FindThreshold(const CompressSource& source, const CodecSettings& settings,
                             double psnr_db, ThreadPool& pool,
                             const std::function<bool()>& is_interrupted);

}  // namespace lf
