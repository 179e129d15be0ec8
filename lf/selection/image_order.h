// In which order LF images are taken (thesis 4.2.1). The *place* of an LF image is its rank there,
// from 0.
//
// An order is of a whole light field. So what is counted in places (limits, stop rules, how far an
// interrupted frame has come) means the same for any choice of frames, any passes and any packages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"

namespace lf {

//   kShuffle     by a seed, whatever the frames: an even result before all have been processed
//   kRoundRobin  frames fill equally: the next image is of the frame that has the fewest rays
//   kArea        images that give all frames together the most rays first: soon much light, but
//                neighbours see alike, so that unfinished bokeh are uneven
enum class ImageOrder { kShuffle, kRoundRobin, kArea };

// "shuffle", "round-robin", "area"
const char* NameOf(ImageOrder order);
std::optional<ImageOrder> ImageOrderOf(const std::string& name);

// Places of LF images: of a whole light field, or of those that a package has.
struct ImagePlaces {
  std::vector<uint32_t> of_images;  // [LfImageId]
  uint32_t end = 0;                 // all are below it: LF images of the whole light field
};

ImagePlaces ShuffledPlaces(size_t image_count, uint64_t seed);

// An LF image that a frame takes.
struct ImageRays {
  LfImageId id;
  uint64_t ray_count = 0;
};

// Images that no frame takes come last; what is equal is as in the shuffle.
//   frames  what each takes, in any order; not used for kShuffle
ImagePlaces PlacesInOrder(ImageOrder order, size_t image_count, uint64_t seed,
                          std::span<const std::vector<ImageRays>> frames);

}  // namespace lf
