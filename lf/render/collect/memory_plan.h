// SPDX-License-Identifier: Apache-2.0
// Divides the memory of a render (--memory) between plates, LF images and their reference images.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Memory that the decoded reference images of predicted LF images take.
struct ReferenceNeed {
  uint64_t all_bytes = 0;  // of all of them together; 0: no LF image is predicted
  // LF images are loaded group after group (ImageOrder::kGroups), so that the reference images of
  // few groups suffice.
  bool in_groups = false;
};

// Returns LfImageStore::ReferenceBytes(), but no more than as many LF images as `light_field` has
// can take, because a package has only some of the LF images of its store.
ReferenceNeed ReferenceNeedOf(const LfImageStore& store, const LightField& light_field,
                              bool in_groups);

struct MemoryPlan {
  // number of frames whose plates are in memory at the same time; the frames of each pass read the
  // LF images again
  size_t frames_per_pass = 1;
  size_t batch_image_count = 1;  // two batches are in memory at the same time (collect.h)
  // number of LF images of a batch that is made of kept pixels (hybrid/frame_pixels.h), beside the
  // batches of LF images that are read; 0: there are no kept pixels
  size_t kept_batch_image_count = 0;
  size_t plan_bytes = 0;  // memory for the plans (PlanBytes()) of a batch's rays
  // number of frames that are developed at the same time after the last batch, in the memory that
  // its LF images had
  size_t frames_finished_at_once = 1;
  size_t image_bytes = 0;  // size of the largest decoded LF image
  // Memory for two batches, for filtered copies of the LF images of one, and for their plans.
  size_t batches_bytes = 0;
  size_t plate_bytes = 0;  // size of the plate of one frame
  // Memory for one LF image in each of two batches, for its filtered copies, and for one plan.
  size_t pair_bytes = 0;
  size_t develop_bytes = 0;  // memory to develop one frame
  size_t least_bytes = 0;    // the least memory_bytes that suffices
  // Memory for decoded reference images (LfImageStore::LimitReferences()).
  size_t reference_bytes = 0;
  // The least memory_bytes for which reference_bytes is as much as pays: all reference images, or
  // those of a few groups with ReferenceNeed::in_groups. 0 if no LF image is predicted.
  size_t enough_bytes = 0;
  size_t total_bytes = 0;  // largest memory of the program; includes all of the above
};

// Divides memory_bytes. First sets memory aside for the program itself, its threads, the
// calibration, the contact sheet and a frame that is developed. About a quarter of the rest, at
// most, is for two batches of LF images and the plans of their rays; more only if one LF image in
// each batch needs more. The plates get what remains. If not all plates fit, the frames are divided
// into passes. A batch has at most the largest of these numbers of LF images, because larger
// batches gain nothing: 16, or as many as take 256 MiB for each frame if these are fewer; one for
// each thread; as many as have the pixels of eight plates together (at most 64). kOutput if the
// memory does not suffice for one plate and two LF images; the message names the least memory that
// suffices. If LF images are prefiltered, the memory of one batch also holds a filtered copy of
// each of its LF images.
//   bytes_per_frame  further memory for each frame, such as its moments (noise_moments.h)
//   is_guarded       true: the plates are guarded (SensorPlate::is_guarded())
//   instants         number of lenses of each frame (CameraPath::Instants()), which have plans of
//                    their own and lens weights. With prefilters, there is memory for a
//                    second filtered copy of each LF image, because elements may become wider than
//                    the next step of the filters while a frame is exposed; a fast zoom needs more
//   surface          the focal surface with the most rows of pieces; null: there is none
//   references       what reference images take. They get all of it, but at most a third of what
//                    remains after the memory that is first set aside, and no more than leaves room
//                    for a plate and, in each of two batches, an LF image for each thread. They get
//                    at least what those of a group for each thread take: kOutput if this does
//                    not fit.
Result<MemoryPlan> PlanMemory(size_t memory_bytes, const LightField& light_field,
                              const RayReading& reading, int plate_width, int plate_height,
                              size_t frame_count, int thread_count, size_t bytes_per_frame = 0,
                              bool is_guarded = false, size_t instants = 1,
                              const FocalSurface* surface = nullptr,
                              const ReferenceNeed& references = {});

}  // namespace lf
