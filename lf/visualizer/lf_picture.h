// LF images as pictures for people.
#pragma once

#include <cstdint>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// [height][width][3] sRGB, as frames are developed (white balance, colour matrix, gain); where the
// image is larger than max_side_px, means of squares of its pixels. Masked pixels are grey.
//   store  one with Mosaics::kToRgb
// kInput: as of store.Load().
Result<Image<uint8_t>> LfPicture(const LightField& light_field, const LfImageStore& store,
                                 LfImageId id, int max_side_px);

}  // namespace lf
