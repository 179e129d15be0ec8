// Where is something sharp? For captures whose optical axes do not meet.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// The focus distance, along the axis of `camera`, at which a small picture taken through a lens of
// `aperture_diameter_w` has the most detail in its middle. Planes evenly spaced in 1/distance from
// `near_w` to `far_w` are tried, then finer ones around the best. Reads at most 64 of the LF
// images behind the lens, twice.
// kInput: no LF image behind the lens; broken images.
Result<double> SharpestFocusDistance(const LightField& light_field, const LfImageStore& store,
                                     const PinholeCamera& camera, double aperture_diameter_w,
                                     double near_w, double far_w, ThreadPool& pool);

}  // namespace lf
