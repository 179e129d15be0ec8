// SPDX-License-Identifier: Apache-2.0
// Checks if the files of a light field, or the encoded images of a packed store, exist and match
// the calibration.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

enum class ImageCheck {
  // For image files, reads the headers and compares the image sizes with the calibration; a
  // truncated file goes unnoticed. For a packed store, reads the table of encoded images; a damaged
  // encoded image goes unnoticed.
  kHeaders,
  kPixels,  // decodes every file or encoded image completely
};

struct ImageFault {
  LfImageId id;
  std::string reason;  // the fault, and the file that has it
};

struct ImageFaults {
  // LF images whose file or mask file does not exist, or that the packed store lacks.
  std::vector<ImageFault> missing;
  // LF images whose header (with kPixels: whose pixels) cannot be read, or whose size differs from
  // the calibration.
  std::vector<ImageFault> broken;
  // Number of LF images that a packed store left out on purpose, because packages did not need
  // them. Their LF cameras are known.
  size_t left_out_count = 0;
};

struct CheckOptions {
  ImageCheck check = ImageCheck::kHeaders;
  const std::atomic<bool>* interrupted = nullptr;  // true ends the check early; null: never
  std::function<void(size_t done, size_t total)> progress;
};

// Checks all LF images and their masks in parallel. The lists are in the order of the LF images;
// each LF image is in at most one of them. kInterrupted: `interrupted` is true. kInput: a packed
// store that cannot be read.
Result<ImageFaults> CheckImages(const LightField& light_field, const CheckOptions& options,
                                ThreadPool& pool);

}  // namespace lf
