// SPDX-License-Identifier: Apache-2.0
// Common parts of the tests of ray collection: LF images of noise, plates for a pair of cameras,
// and the difference of two plates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/testing_scenes.h"
#include "lf/collection/gather.h"
#include "lf/core/random.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf::testing {

inline PixelRect WholeImage(const CameraPair& pair) {
  return {0, 0, pair.lf_camera.intrinsics.width_px, pair.lf_camera.intrinsics.height_px};
}

inline LfPixels NoisePixels(const PixelRect& rect, BayerPattern bayer, uint64_t seed) {
  LfPixels pixels(rect, bayer);
  uint64_t index = 0;
  const int colours = bayer == BayerPattern::kNone ? 3 : 1;
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x)
      for (int c = 0; c < colours; ++c)
        pixels.radiance.at(x, y, c) = static_cast<uint16_t>(RandomBits(seed, 7, index++));
  return pixels;
}

inline SensorPlate PlateFor(const CameraPair& pair, uint32_t limit = SensorPlate::kMaxCount) {
  return SensorPlate(pair.render_camera.pinhole.intrinsics.width_px,
                     pair.render_camera.pinhole.intrinsics.height_px, limit);
}

// Returns weights that are of_block(end_x, end_y) in the block that ends before (end_x, end_y).
template <class OfBlock>
RayWeights WeightsByBlock(const WeightBlocks& blocks, const OfBlock& of_block) {
  return RayWeights(blocks, [of_block](int end_x, int end_y, int count, uint8_t* weights) {
    for (int i = 0; i < count; ++i)
      weights[i] = static_cast<uint8_t>(of_block(end_x + i * kWeightBlock, end_y));
  });
}

// Returns the pixels filtered by the prefilter of the plan, as GatherTile() needs them.
inline LfPixels PixelsFor(const GatherPlan& plan, const LfPixels& pixels) {
  if (plan.sampling.prefilter.changes_nothing()) return pixels;
  LfPixels filtered;
  FilterPixels(plan.sampling.prefilter, pixels, &filtered);
  return filtered;
}

inline TileGrid GridOf(const SensorPlate& plate, int tile_width, int tile_height) {
  return {plate.width(), plate.height(), tile_width, tile_height};
}

inline uint64_t TotalCount(const SensorPlate& plate) {
  uint64_t count = 0;
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int channel = 0; channel < 3; ++channel) count += plate.At(x, y, channel).count;
  return count;
}

// Returns the difference of the counts of the two plates, summed over elements and channels.
// A channel of an element with equal counts but different sums adds 1. A ray that lies in different
// elements of the two plates adds 2 for each of its channels.
inline uint64_t DifferingCount(const SensorPlate& a, const SensorPlate& b) {
  uint64_t count = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const ElementSum sum_a = a.At(x, y, channel), sum_b = b.At(x, y, channel);
        if (sum_a == sum_b) continue;
        count += std::max<uint64_t>(
            1, std::max(sum_a.count, sum_b.count) - std::min(sum_a.count, sum_b.count));
      }
  return count;
}

// Calls collect(tile, &sums) for every tile of the plate, and flushes the sums to the plate after
// each call. Returns the sum of the results of collect().
//   ray_limit  passed to TileSums
template <class Collect>
uint64_t InTiles(SensorPlate* plate, const TileGrid& grid, const Collect& collect,
                 uint32_t ray_limit = TileSums::kMaxRays) {
  uint64_t accepted = 0;
  TileSums sums(ray_limit);
  std::vector<PlateTile> tiles = CutIntoTiles(plate, grid);
  for (size_t tile = 0; tile < tiles.size(); ++tile) {
    sums.Begin(&tiles[tile]);
    accepted += collect(tile, &sums);
    sums.Flush();
  }
  return accepted;
}

}  // namespace lf::testing
