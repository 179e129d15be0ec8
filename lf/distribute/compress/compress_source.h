// SPDX-License-Identifier: Apache-2.0
// The input of a packed store: all LF cameras of a light field, and which pixels are encoded.
#pragma once

#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/render/package/package.h"

namespace lf {

struct CompressSource {
  // The whole light field. Its encoding states the footprint of LF pixels, because that is measured
  // from a few LF images, which a store may leave out or change.
  LightField light_field;
  LightFieldIdentity whole;  // identity of `light_field`
  // Pixels to compress of each LF image; an empty rectangle: the LF image is left out. A store has
  // the LF cameras of all LF images, so that the order of LF images, lens weights and the choice of
  // rebinned rays are those of the whole light field.
  std::vector<PixelRect> rects;

  // Returns the ids of the LF images that are not left out, ascending; there is at least one.
  std::vector<LfImageId> CompressedIds() const;
};

// Returns all LF images of the light field, with all their pixels. kUsage: the light field is a
// packed store already. kOutput as MeasureFootprint(), which is called if the calibration does not
// state the footprint.
Result<CompressSource> SourceOfAll(LightField light_field);

// Returns the LF images from which frames of the packages take rays, and leaves out all others.
//   light_field    the light field that the packages were made from
//   needed_pixels  true: of each LF image, only the bounds of the pixels that these frames need;
//                  false: all pixels
// The result has the radiance encoding of the packages. kUsage: the packages are of different light
// fields or of a packed store, or none of their frames takes a ray. kInput: `light_field` is
// another one than that of the packages. kOutput as SourceOfAll().
Result<CompressSource> SourceOfPackages(LightField light_field, std::span<const Package> packages,
                                        bool needed_pixels);

}  // namespace lf
