// SPDX-License-Identifier: Apache-2.0
// Counts of the rays of a frame, and the LF images that it lacks.
#pragma once

#include <cstdint>
#include <string>

namespace lf {

// The rays that were collected into the plate of a frame.
struct FrameRays {
  uint64_t image_count = 0;  // number of recorded LF images with an accepted ray
  // number of LF pixels in the rectangles that the frame needs, sum of its instants
  uint64_t tested_count = 0;
  // Number of rays that were added to the plate. It includes rays of weight 0, except in tiles of
  // the plate (TileSums::GridOf()) whose elements all have weight 0, because these are passed over.
  uint64_t accepted_count = 0;
  uint64_t virtual_count = 0;  // number of virtual LF images with an accepted ray

  FrameRays& operator+=(const FrameRays& more) {
    image_count += more.image_count;
    tested_count += more.tested_count;
    accepted_count += more.accepted_count;
    virtual_count += more.virtual_count;
    return *this;
  }
};

// An LF image that was left out, because it is missing or broken.
struct SkippedImage {
  std::string name;    // name in LightField::image_names
  std::string reason;  // says why it was skipped, for messages
  uint32_t rank = 0;   // rank of the LF image in the order
};

// How many rays the elements of a frame have. MeasureSamples() (sample_rule.h) measures it.
struct SampleShare {
  // Share of the reachable elements that have at least the asked number of rays in every channel; 1
  // if no element is reachable.
  double share = 1;
  uint64_t most_have = 0;  // largest N for which the rule "samples>=N" is met
};

}  // namespace lf
