// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/load_mosaics.h"

#include <fmt/format.h>

#include "lf/storage/load/demosaic.h"

namespace lf {

Result<void> LoadMosaicsAs(Mosaics mosaics, const LightField& light_field, LfImageId id,
                           const PixelRect& rect,
                           const std::function<Result<void>(const PixelRect&, LfPixels*)>& load,
                           LfPixels* mosaic, LfPixels* pixels) {
  const bool is_mosaic = light_field.encoding.bayer != BayerPattern::kNone;
  if (!is_mosaic || mosaics == Mosaics::kAsRecorded) return load(rect, pixels);
  const Intrinsics& k = light_field.intrinsics[light_field.cameras[id.value].intrinsics_index];
  if (k.width_px < 2 || k.height_px < 2)
    return InputError(
        fmt::format("{}: has {} x {} pixels: expected a mosaic of at least 2 x 2 pixels",
                    light_field.ImagePath(id).string(), k.width_px, k.height_px));
  const PixelRect inside = Intersection(rect, {0, 0, k.width_px, k.height_px});
  LF_RETURN_IF_ERROR(load(MosaicRectOf(inside, k.width_px, k.height_px), mosaic));
  Demosaic(*mosaic, k.width_px, k.height_px, light_field.encoding, inside, pixels);
  return {};
}

}  // namespace lf
