// SPDX-License-Identifier: Apache-2.0
// Finds the LF images that were skipped (SkippedImage) and whose rays a frame therefore lacks.
// Internal to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/hybrid/gap_lens.h"
#include "lf/render/settings/shard.h"
#include "lf/selection/select.h"

namespace lf {

// The properties of a frame that decide which LF images it takes.
struct FrameTakes {
  // The frame takes an LF image if any of its lenses or gaps does.
  std::vector<const FrameLens*> lenses;
  std::vector<const GapLens*> gaps;
  RankRange ranks;
  PixelReach reach = PixelReach::kOwn;
  std::optional<Shard> shard;  // shard of the render; unset: all LF images
};

// Returns the names of the skipped LF images that the frame would have taken, ascending by
// LfImageId. The names do not depend on threads, memory or interruptions. The time grows with the
// number of LF images in the light field, unless nothing was skipped.
std::vector<std::string> SkippedOf(std::span<const SkippedImage> skipped, const ImageIndex& index,
                                   const FrameTakes& frame);

}  // namespace lf
