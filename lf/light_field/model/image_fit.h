// Decides whether the pixels of an image file are those that were calibrated.
#pragma once

#include <string>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

enum class ImageFit {
  kAsStored,  // calibrated as stored; the orientation tag is ignored
  kTurned,    // calibrated after the turn by 90 degrees that the tag asks for
              // (pixels/files/upright.h)
};

// Compares sizes. A picture of the calibrated size is used as stored. A picture whose width and
// height are exchanged, and whose tag exchanges them, was turned before it was calibrated. A mosaic
// is never turned, because its Bayer pattern would change. Square pictures, and tags that mirror or
// turn by 180 degrees, cannot be told apart by size and are used as stored.
//   name  of the file, for messages
// kInput for any other size; the message names both sizes and a remedy.
Result<ImageFit> FitToCalibration(const ImageFileInfo& info, bool is_mosaic,
                                  const Intrinsics& calibrated, const std::string& name);

}  // namespace lf
