// SPDX-License-Identifier: Apache-2.0
// The order in which frames take LF images (thesis 4.2.1). The *rank* of an LF image is its
// position in the order, from 0.
//
// An order always contains all LF images of the whole light field, and is made for all frames of a
// film. A rank (in limits, stop rules, and the progress of an interrupted frame) therefore means
// the same for any choice of frames, any passes and any packages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

//   kSpread      every beginning is spread evenly over the positions of the LF cameras
//                (spread_order.h), which with a seed are all that it depends on: unfinished frames
//                are nearest to finished ones
//   kGroups      groups of neighbouring LF images one after another, and the groups spread evenly
//                (group_order.h): a film that takes all predicted LF images of a packed store
//                decodes each about once with little memory, but unfinished frames are worst,
//                because their lens has holes; depends on positions and the seed alone
//   kShuffle     random, depends only on a seed and not on the frames: the result is even among all
//                frames, also before all LF images are processed
//   kRoundRobin  all frames get rays equally fast: the next LF image is one that the frame with the
//                fewest rays so far takes
//   kArea        LF images with the most rays, summed over all frames, come first: gives many rays
//                soon, but neighbouring LF images follow each other, so that the bokeh of
//                unfinished frames is uneven
enum class ImageOrder { kSpread, kShuffle, kRoundRobin, kArea, kGroups };

// Returns true for kRoundRobin and kArea.
bool DependsOnFrames(ImageOrder order);

// Returns true for kArea and kGroups, in which neighbouring LF images follow each other. The first
// LF images of a frame are then no sample of all of them: the noise of their mean says nothing
// about the difference to the finished frame.
bool TakesNeighboursTogether(ImageOrder order);

// Convert an order to "spread", "shuffle", "round-robin", "area" or "groups", and back.
// ImageOrderOf() returns nullopt for any other text.
const char* NameOf(ImageOrder order);
std::optional<ImageOrder> ImageOrderOf(const std::string& name);

// The ranks in the order of the LF images of a whole light field, or of a package.
struct ImageRanks {
  std::vector<uint32_t> of_images;  // [LfImageId] rank of the LF image
  uint32_t end = 0;                 // number of LF images of the whole light field
};

ImageRanks ShuffledRanks(size_t image_count, uint64_t seed);
// Returns the ranks of all LF images in an order that does not depend on frames.
ImageRanks RanksOf(ImageOrder order, const LightField& light_field, uint64_t seed);

// An LF image that a frame takes, and the number of its rays for that frame.
struct ImageRays {
  LfImageId id;
  uint64_t ray_count = 0;
};

// Returns the ranks of all LF images in an order that depends on frames. LF images that no frame
// takes come last. LF images that the order does not distinguish are in the order of kShuffle.
//   frames  for each frame, the LF images that it takes, in any order
ImageRanks RanksInOrder(ImageOrder order, size_t image_count, uint64_t seed,
                        std::span<const std::vector<ImageRays>> frames);

}  // namespace lf
