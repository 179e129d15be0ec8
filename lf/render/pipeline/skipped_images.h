// The skipped LF images that a frame lacks. Internal to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/render/collect/collect.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/state/shard.h"
#include "lf/selection/select.h"

namespace lf {

// The properties of a frame that decide which LF images it takes.
struct FrameTakes {
  const FrameLens& lens;
  PlaceRange places;
  PixelReach reach = PixelReach::kOwn;
  std::optional<Shard> shard;  // of the render
};

// Returns the names of the skipped LF images that the frame would have taken, in the order of the
// light field. They do not depend on threads, memory or interruptions. Reads all names of the light
// field once, unless nothing was skipped.
std::vector<std::string> SkippedOf(std::span<const SkippedImage> skipped, const ImageIndex& index,
                                   const FrameTakes& frame);

}  // namespace lf
