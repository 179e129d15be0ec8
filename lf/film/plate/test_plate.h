// SPDX-License-Identifier: Apache-2.0
// Plates with all kinds of words (empty, packed and wide), for tests of their files.
#pragma once

#include "lf/core/random.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf::testing {

// Returns a plate of noise. About every tenth word is empty. If `has_wide`, two words have more
// rays than a packed word can count; other words are wide only if they have more than count_limit
// rays.
inline SensorPlate NoisePlate(int width, int height, uint64_t seed, uint32_t count_limit,
                              bool has_wide) {
  SensorPlate plate(width, height, count_limit);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < SensorPlate::kChannels; ++c) {
        const uint64_t bits =
            RandomBits(seed, static_cast<uint64_t>(c), static_cast<uint64_t>(y) * 4096 + x);
        if (bits % 10 == 0) continue;
        const uint64_t count = 1 + (bits >> 8) % 40;
        plate.Add(x, y, c, {((bits >> 16) & 0xffff) * count, count});
      }
  if (has_wide) {
    plate.Add(width - 1, height / 2, 1, {uint64_t{65535} << 24, uint64_t{1} << 24});
    plate.Add(0, 0, 2, {uint64_t{17} << 25, uint64_t{1} << 25});
  }
  return plate;
}

// Returns a plate of noise in all channels of its kind.
inline SensorPlate NoisePlateOf(PlateKind kind, int width, int height, uint64_t seed) {
  SensorPlate plate(width, height, kind);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < plate.channels(); ++c) {
        const uint64_t bits =
            RandomBits(seed, static_cast<uint64_t>(c), static_cast<uint64_t>(y) * 4096 + x);
        const uint64_t count = bits % 40;
        plate.Add(x, y, c, {((bits >> 16) & 0xffff) * count, count});
      }
  return plate;
}

}  // namespace lf::testing
