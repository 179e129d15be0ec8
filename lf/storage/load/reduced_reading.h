// SPDX-License-Identifier: Apache-2.0
// Loads LF images from JPEG files in a fraction of their size. FolderStore and PackedStore share
// it. Internal to this folder.
#pragma once

#include <functional>
#include <string>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/reduced_jpeg.h"
#include "lf/storage/load/radiance_conversion.h"

namespace lf {

// Loads an LF image without masks as LfImageStore::LoadReduced() says. Returns 1, without loading
// pixels, if it cannot be reduced: the file is no JPEG, is turned against the calibration, holds a
// mosaic or opacities, or the divisor is odd. Errors are those of LoadReduced().
//   read  ReadReducedJpeg() or ReadReducedJpegBytes() of the file
//   name  of the file, for messages
//   part  memory for the stored values
Result<int> LoadReducedFile(
    const std::function<Result<int>(const WantedReduction& wanted, ImagePart* part)>& read,
    const std::string& name, const LightField& light_field, LfImageId id, int divisor,
    const RadianceTables& tables, ImagePart* part, LfPixels* pixels);

}  // namespace lf
