// The order in which the LF images of a film are taken (selection/image_order.h), computed from the
// needs of its frames.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/selection/image_order.h"

namespace lf {

// Returns the ranks of all LF images in the order for all frames of the film, even if only some are
// rendered, so that a number of ranks has one meaning for any choice of frames. LF images that no
// frame sees, or that have no lens weight in any frame, come last.
//   needs  of the later renders; max_image_count is ignored
// kInterrupted.
Result<ImagePlaces> PlacesOfFilm(ImageOrder order, uint64_t seed, const LightField& light_field,
                                 const CameraPath& path, const NeedsOptions& needs,
                                 ThreadPool& pool);

// Returns how densely the light field was recorded around each frame of the film, [frame - 1].
// kInterrupted.
Result<std::vector<FrameSampling>> SamplingOfFilm(const ImageIndex& index, const CameraPath& path,
                                                  const SelectOptions& select, ThreadPool& pool);

}  // namespace lf
