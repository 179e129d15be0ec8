// Whether the pixels of an image file are those that were calibrated.
#pragma once

#include <string>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/imageio/image_file.h"

namespace lf {

enum class ImageFit {
  kAsStored,  // the calibration is of the pixels as stored, whatever the orientation tag says
  kTurned,    // it is of the picture turned by 90 degrees as the tag says (imageio/upright.h)
};

// By sizes: a picture of the calibrated size is taken as stored; one whose width and height are
// exchanged, with a tag that exchanges them, was turned before it was calibrated. A mosaic is never
// turned: its pattern would be another one. For square pictures, and tags that turn by 180 degrees
// or mirror, nothing can be told: as stored.
//   name  of the file, for messages
// kInput: any other size; the message names both, and says what to do.
Result<ImageFit> FitToCalibration(const ImageFileInfo& info, bool is_mosaic,
                                  const Intrinsics& calibrated, const std::string& name);

}  // namespace lf
