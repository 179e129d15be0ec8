// What goes into a packed store: LF images of a light field, whole or in part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/capture/light_field_identity.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/package/package.h"

namespace lf {

struct CompressSource {
  LightField light_field;           // of these LF images alone
  LightFieldIdentity whole;         // that they are from
  std::vector<uint32_t> whole_ids;  // in it, as light_field.cameras; empty: 0, 1, 2, ...
  std::vector<PixelRect> rects;     // pixels that are asked for, as light_field.cameras
};

// All of a light field. kUsage: it is a packed store already.
Result<CompressSource> SourceOfAll(LightField light_field);

// The LF images that frames of some packages take rays from, in the order of the light field.
//   needed_pixels  of each only the bounds of those frames' rectangles, else all
// kUsage: the packages are of different light fields, or none of their frames takes any.
Result<CompressSource> SourceOfPackages(std::span<const Package> packages, bool needed_pixels);

}  // namespace lf
