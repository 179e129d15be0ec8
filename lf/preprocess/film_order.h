// The order in which the LF images of a film are taken (selection/image_order.h), by what its
// frames need.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/path/camera_path.h"
#include "lf/preprocess/frame_needs.h"
#include "lf/selection/image_order.h"

namespace lf {

// Returns the places of all LF images in the order for all frames of the film, whichever of them
// are rendered: what is counted in places means the same for any choice of frames. An LF image
// without lens weight in any frame comes last, as does one that no frame sees.
//   needs  of the renders to come; max_image_count has no say
// kInterrupted.
Result<ImagePlaces> PlacesOfFilm(ImageOrder order, uint64_t seed, const LightField& light_field,
                                 const CameraPath& path, const NeedsOptions& needs,
                                 ThreadPool& pool);

// Returns how densely the light field was recorded around each frame of the film, [frame - 1].
// kInterrupted.
Result<std::vector<FrameSampling>> SamplingOfFilm(const ImageIndex& index, const CameraPath& path,
                                                  const SelectOptions& select, ThreadPool& pool);

}  // namespace lf
