// SPDX-License-Identifier: Apache-2.0
// Loads pixels for any store, with mosaics as recorded or converted to RGB. Internal to this
// folder.
#pragma once

#include <functional>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Loads the pixels of `rect`, clipped to the image. Calls load(part, pixels), which must load
// pixels as recorded. `part` is MosaicRectOf(rect) if a mosaic is to be converted to RGB, otherwise
// `rect` itself, which load() must clip to the image.
//   mosaic  memory for the mosaic that is converted
// kInput: a mosaic to convert is smaller than 2 x 2 pixels. Passes on errors of load().
Result<void> LoadMosaicsAs(Mosaics mosaics, const LightField& light_field, LfImageId id,
                           const PixelRect& rect,
                           const std::function<Result<void>(const PixelRect&, LfPixels*)>& load,
                           LfPixels* mosaic, LfPixels* pixels);

}  // namespace lf
