// SPDX-License-Identifier: Apache-2.0
// The input of a packed store: LF images of a light field, whole or in part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/render/package/package.h"

namespace lf {

struct CompressSource {
  LightField light_field;           // contains only the LF images to compress
  LightFieldIdentity whole;         // the whole light field that the LF images are taken from
  std::vector<uint32_t> whole_ids;  // id in `whole` of each LF image of `light_field`; empty:
                                    // 0, 1, 2, ...
  std::vector<PixelRect> rects;     // pixels to compress of each LF image of `light_field`
};

// Returns all LF images of the light field, with all their pixels. kUsage: the light field is a
// packed store already.
Result<CompressSource> SourceOfAll(LightField light_field);

// Returns the LF images from which frames of the packages take rays, in the order of the light
// field.
//   needed_pixels  true: of each LF image, only the bounds of the pixels that these frames need;
//                  false: all pixels
// kUsage: the packages are of different light fields or of a packed store, or none of their frames
// takes a ray.
Result<CompressSource> SourceOfPackages(std::span<const Package> packages, bool needed_pixels);

}  // namespace lf
