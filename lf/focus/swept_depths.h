// SPDX-License-Identifier: Apache-2.0
// Finds the range of depths of a scene from its LF images alone.
#pragma once

#include <optional>
#include <string>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the LF camera nearest to a position; the first one of several. The light field must have
// a camera.
LfImageId NearestCamera(const LightField& light_field, const Vec3& position_world);

// Runs FindSubject() for the LF camera nearest to a position. Returns the range of depths, along
// the camera's optical axis, that contains four fifths of the depths found in its image, widened by
// 5 % at either end. None if this range is not sure, if FindSubject() fails, or if there are fewer
// than three LF images.
//   store  a store with Mosaics::kToRgb
//   why    receives, if there is no range, which LF images could not be loaded: "" if all could;
//          may be null
std::optional<DepthRange> SweptDepths(const LightField& light_field, const LfImageStore& store,
                                      const Vec3& position_world, ThreadPool& pool,
                                      std::string* why = nullptr);

}  // namespace lf
