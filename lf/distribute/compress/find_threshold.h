// SPDX-License-Identifier: Apache-2.0
// Finds the threshold for a given quality. Internal to this folder.
#pragma once

#include <functional>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/distribute/compress/encoding.h"
#include "lf/distribute/compress/image_use.h"

namespace lf {

// Returns a threshold in grey steps: the largest at which a sample of LF images, spread over the
// light field, or of whole groups if they are predicted, has a PSNR of at least `psnr_db` over all
// its values. Thresholds are tried in steps of 5 %. The result does not depend on the number of
// threads. kUsage: no threshold of the profile reaches the quality, or the profile has no
// threshold; kInput: no image of the sample can be read. kInterrupted: is_interrupted() returned
// true.
//   use  if not null, the PSNR is that of the frames together, which PredictFrames() predicts: each
//        LF image is taken to have the error that the sample has on average at its threshold. The
//        error is measured at thresholds that differ by factors of 2^(1/2), and interpolated.
Result<double> FindThreshold(const CompressSource& source, const Encoding& encoding, double psnr_db,
                             const ImageUse* use, ThreadPool& pool,
                             const std::function<bool()>& is_interrupted);

}  // namespace lf
