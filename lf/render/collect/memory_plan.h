// How --memory is shared between plates and LF images.
#pragma once

#include <cstddef>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"

namespace lf {

struct MemoryPlan {
  size_t frames_per_pass = 1;  // plates kept at the same time; each pass reads the LF images again
  size_t batch_image_count = 1;        // two batches are kept at the same time (collect.h)
  size_t plan_bytes = 0;               // memory for the plans of a batch's rays
  size_t frames_finished_at_once = 1;  // after the last batch, in the memory of the LF images
  size_t image_bytes = 0;              // the largest decoded LF image
  size_t plate_bytes = 0;
  size_t total_bytes = 0;  // all of this, and the program itself
};

// Memory is set aside for the program itself, its threads and a developing frame. A quarter of the
// rest holds two batches of LF images, and plates take what is left. If not all plates fit, frames
// are cut into passes. Batches are not larger than is useful: 16 LF images, two for each thread, or
// as many pixels as eight plates have (64 images at most), whichever is most. kOutput if the memory
// is not enough for one plate and two LF images; the message names the least that is.
//   bytes_per_frame  kept beside each plate, such as moments (noise_moments.h)
Result<MemoryPlan> PlanMemory(size_t memory_bytes, const LightField& light_field,
                              Estimator estimator, int plate_width, int plate_height,
                              size_t frame_count, int thread_count, size_t bytes_per_frame = 0);

}  // namespace lf
