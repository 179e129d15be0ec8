// Finds the range of depths of a scene from its LF images alone.
#pragma once

#include <optional>

#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the range of depths, along the optical axis of the LF camera nearest to a position, that
// contains four fifths of the places which FindSubject() finds in its image, and 5 % more on either
// side. None if the subject is not sure, or if the camera's image cannot be read.
//   store  one with Mosaics::kToRgb
std::optional<DepthRange> SweptDepths(const LightField& light_field, const LfImageStore& store,
                                      const Vec3& position_world, ThreadPool& pool);

}  // namespace lf
