// SPDX-License-Identifier: Apache-2.0
// Finds places of the scene in several LF images, without using poses for more than the choice of
// these images. Internal to this folder.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// A place of the scene in one LF image.
struct Sighting {
  uint32_t image = 0;  // index of the LF image
  Vec2 at_px = Vec2::Zero();
};
// A place and where LF images show it: first the LF image that it was searched from.
struct SeenPlace {
  Sighting from;
  std::vector<Sighting> others;  // at least one
};

// Returns the largest distance between the positions of a place in SeenPlace::from and in another
// LF image, in pixels.
double LongestMove(const SeenPlace& place);

struct FoundPlaces {
  std::vector<SeenPlace> places;
  size_t image_count = 0;   // number of LF images that were read
  size_t pair_count = 0;    // number of pairs of LF images that show places in common
  size_t tried_count = 0;   // number of pairs that were compared
  double corner_count = 0;  // mean number of corners of an LF image
  double move = 0;          // median LongestMove(), in reduced pixels; 0 without places
  int divisor = 1;          // LF pixels along a side of a reduced pixel
};

// Compares up to eight LF images, spread over the names, each with up to 15 others: LF cameras
// around it by their poses, in growing rings, and neighbours by name. Both are needed, because
// poses or names may be wrong. Places that stand still in all LF images are left out, like
// watermarks and the background of a turntable. LF images that cannot be read are left out.
// kOutput: the machine lacks memory or open files. kInterrupted: `interrupted` is true.
//   store        a store with Mosaics::kToRgb
//   interrupted  true ends the search early; null: never
Result<FoundPlaces> FindPlaces(const LightField& light_field, const LfImageStore& store,
                               ThreadPool& pool, const std::atomic<bool>* interrupted);

}  // namespace lf
