// Between which depths a scene lies, where only its LF images tell it.
#pragma once

#include <optional>

#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// Returns the depths between which four fifths of the places lie that the LF camera nearest to a
// position shows, 5 % more to either side: by FindSubject(), along the camera's optical axis. None
// if that is not sure, or if the camera's image cannot be read.
//   store  one with Mosaics::kToRgb
std::optional<DepthRange> SweptDepths(const LightField& light_field, const LfImageStore& store,
                                      const Vec3& position_world, ThreadPool& pool);

}  // namespace lf
