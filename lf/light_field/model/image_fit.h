// SPDX-License-Identifier: Apache-2.0
// Decides whether an image file has the pixels that were calibrated.
#pragma once

#include <string>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

enum class ImageFit {
  kAsStored,  // the file was calibrated as stored; its orientation tag is ignored
  kTurned,    // calibrated after the quarter turn that the tag requests (pixels/files/upright.h)
};

// Compares the size of a file with the calibrated size. A picture of the calibrated size is used as
// stored. A picture whose width and height are exchanged, and whose orientation tag exchanges them,
// was turned before it was calibrated. A mosaic is never turned, because its Bayer pattern would
// change. A square picture is used as stored, and so is a picture whose tag mirrors it or turns it
// by 180 degrees, because the size does not show whether it was turned before it was calibrated.
//   name  name of the file, for messages
// kInput for any other size; the message states both sizes and a remedy.
Result<ImageFit> FitToCalibration(const ImageFileInfo& info, bool is_mosaic,
                                  const Intrinsics& calibrated, const std::string& name);

}  // namespace lf
