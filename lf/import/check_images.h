// Whether the files of a light field are there, and are what its calibration says; or the codes of
// a packed store.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"

namespace lf {

enum class ImageCheck {
  // The files' headers: the size; a truncated file goes unnoticed. Of a packed store its table of
  // codes: a damaged one goes unnoticed.
  kHeaders,
  kPixels,  // all of every file, or code, is decoded
};

struct ImageFault {
  LfImageId id;
  std::string reason;  // names the file
};

struct ImageFaults {
  std::vector<ImageFault> missing;  // no such file
  // The header (kPixels: the pixels) cannot be read, or the size is not that of the calibration.
  std::vector<ImageFault> broken;
};

struct CheckOptions {
  ImageCheck check = ImageCheck::kHeaders;
  const std::atomic<bool>* interrupted = nullptr;  // looked at now and then
  std::function<void(size_t done, size_t total)> progress;
};

// All LF images and their masks, in parallel; the lists are in the order of the LF images, which
// stand in at most one of them. kInterrupted; kInput: a packed store that cannot be read.
Result<ImageFaults> CheckImages(const LightField& light_field, const CheckOptions& options,
                                ThreadPool& pool);

}  // namespace lf
