// Mosaics as recorded or as RGB, whatever store they come from. Internal to store.
#pragma once

#include <functional>

#include "lf/capture/lf_pixels.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// The pixels of `rect`, cut to the image, by load(part, pixels), which gives them as recorded and
// is asked for the mosaic around `rect` if that becomes RGB.
//   mosaic  memory for that
// kInput: a mosaic below 2 x 2 pixels, and what load() says.
Result<void> LoadMosaicsAs(Mosaics mosaics, const LightField& light_field, LfImageId id,
                           const PixelRect& rect,
                           const std::function<Result<void>(const PixelRect&, LfPixels*)>& load,
                           LfPixels* mosaic, LfPixels* pixels);

}  // namespace lf
