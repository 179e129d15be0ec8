// The order in which LF images are taken (thesis 4.2.1). The *place* of an LF image is its rank in
// the order, from 0.
//
// An order is that of a whole light field. Numbers of places (limits, stop rules, the progress of
// an interrupted frame) therefore mean the same for any choice of frames, any passes and any
// packages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"

namespace lf {

//   kShuffle     random by a seed, whatever the frames: gives an even result before all LF images
//                are processed
//   kRoundRobin  frames fill equally: the next image is one of the frame that has the fewest rays
//   kArea        images that give all frames together the most rays come first: gives much light
//                soon, but neighbours follow each other, so that unfinished bokeh is uneven
enum class ImageOrder { kShuffle, kRoundRobin, kArea };

// Convert an order to "shuffle", "round-robin" or "area", and back; none for any other text.
const char* NameOf(ImageOrder order);
std::optional<ImageOrder> ImageOrderOf(const std::string& name);

// Places of the LF images of a whole light field, or of a package.
struct ImagePlaces {
  std::vector<uint32_t> of_images;  // [LfImageId]
  uint32_t end = 0;                 // exclusive bound: number of LF images of the whole light field
};

ImagePlaces ShuffledPlaces(size_t image_count, uint64_t seed);

// An LF image that a frame takes.
struct ImageRays {
  LfImageId id;
  uint64_t ray_count = 0;
};

// Images that no frame takes come last. Images that are equal in the order are in the order of the
// shuffle.
//   frames  LF images that each frame takes, in any order; not used for kShuffle
ImagePlaces PlacesInOrder(ImageOrder order, size_t image_count, uint64_t seed,
                          std::span<const std::vector<ImageRays>> frames);

}  // namespace lf
