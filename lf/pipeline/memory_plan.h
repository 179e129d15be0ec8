// How --memory is shared between plates and LF images.
#pragma once

#include <cstddef>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

struct MemoryPlan {
  size_t frames_per_pass = 1;  // plates kept at the same time; each pass reads the LF images again
  size_t batch_image_count = 1;  // two batches are kept at the same time
  size_t image_bytes = 0;        // the largest decoded LF image, with what decoding needs
  size_t plate_bytes = 0;
};

// A quarter of the memory holds LF images, what a developing frame and the program itself need is
// set aside, plates take the rest.
// kOutput: not enough for one plate and two LF images; the message names the least that is.
Result<MemoryPlan> PlanMemory(size_t memory_bytes, const LightField& light_field, int plate_width,
                              int plate_height, size_t frame_count);

}  // namespace lf
