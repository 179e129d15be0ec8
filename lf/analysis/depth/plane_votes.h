// SPDX-License-Identifier: Apache-2.0
// Finds the depths of a frame's elements from those that a densified store has of recorded LF
// images. Internal to this folder.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/lf_depths.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns, for each element, the largest inverse depth along the optical axis of the frame of the
// points of an LF image that project to it, [height][width]; NaN where none does.
Image<float> ProjectedDepths(const LfDepths& depths, const PinholeCamera& lf_camera,
                             const RenderCamera& frame);

struct VotedDepths {
  Image<float> inverse;     // [height][width] inverse depth along the optical axis; NaN: unknown
  Image<float> confidence;  // [height][width] from 0 to 1
  DepthRange range;         // from the nearest to the farthest of the known depths
  size_t view_count = 0;    // LF images whose depths were used
};

// Elects the depth of each element: that on which most LF images agree, and of several the nearest.
// It is the mean of theirs. The confidence is the share of those that agree among those that show
// the element; an element on which fewer than two agree has none.
//   candidates  ProjectedDepths() of LF images, of one size
//   tolerance   of inverse depths that count as equal
VotedDepths Vote(std::span<const Image<float>> candidates, double tolerance, ThreadPool& pool);

// Elects the depths of a frame with the 12 LF images nearest to its camera of which a store has
// depths. Depths are equal if points at them differ by at most 1.25 elements in an LF image at the
// median distance of these.
//   store  opened for depths
// kUsage: the store has no depths of three LF images. kInput: no element has a depth. kInterrupted:
// *stop became true.
Result<VotedDepths> VoteDepths(const LightField& light_field, const LfImageStore& store,
                               const RenderCamera& frame, ThreadPool& pool,
                               const std::atomic<bool>* stop);

}  // namespace lf
