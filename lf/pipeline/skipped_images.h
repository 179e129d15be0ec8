// Which frames lack an LF image that was left out. Internal to pipeline.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/collector/collect.h"
#include "lf/collector/frame_lens.h"
#include "lf/record/shard.h"
#include "lf/selection/select.h"

namespace lf {

// One frame as its LF images are selected.
struct FrameTakes {
  const FrameLens& lens;
  PlaceRange places;
  PixelReach reach = PixelReach::kOwn;
  std::optional<Shard> shard;  // of the render
};

// The names of those of `skipped` that the frame would have taken, in the order of the light field.
// They do not depend on threads, memory or interruptions. Goes through all names of the light field
// once, unless nothing was skipped.
std::vector<std::string> SkippedOf(std::span<const SkippedImage> skipped, const ImageIndex& index,
                                   const FrameTakes& frame);

}  // namespace lf
