// SPDX-License-Identifier: Apache-2.0
// Plates of noise, of any kind, for tests of how they are developed.
#pragma once

#include "lf/core/random.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf::testing {

// Returns a plate of noise: each channel of an element has 1 to `max_rays` rays with the
// probability `density`, otherwise none.
inline SensorPlate RandomPlate(int width, int height, double density, uint64_t max_rays,
                               uint64_t seed) {
  SensorPlate plate(width, height);
  uint64_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c, ++i) {
        if (RandomUnit(seed, 0, i) >= density) continue;
        const uint64_t count = 1 + RandomBits(seed, 1, i) % max_rays;
        plate.Add(x, y, c, {RandomBits(seed, 2, i) % (65535 * count + 1), count});
      }
  return plate;
}

// Returns a plate with the colours of `colours`, whose opacity is its red channel.
inline SensorPlate WithRedOpacity(const SensorPlate& colours) {
  SensorPlate plate(colours.width(), colours.height(), PlateKind::kOpacity);
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x)
      for (int c = 0; c < plate.channels(); ++c) plate.Add(x, y, c, colours.At(x, y, c % 3));
  return plate;
}

// Every eleventh element of GuardedOf() has no recorded rays.
inline bool IsRecorded(int x, int y) { return (x + y) % 11 != 0; }

// Returns a guarded plate with the colours of two plates, and the same defocus and trust in every
// element. Opacities are the red channels.
inline SensorPlate GuardedOf(const SensorPlate& recorded, const SensorPlate& all, double defocus,
                             double trust, PlateKind kind = PlateKind::kGuarded) {
  SensorPlate plate(recorded.width(), recorded.height(), kind);
  const int colours = plate.has_opacity() ? 4 : 3;
  for (int y = 0; y < plate.height(); ++y)
    for (int x = 0; x < plate.width(); ++x) {
      const auto rays_of = [](double value, uint64_t count) {
        return ElementSum{static_cast<uint64_t>(value * 60000) * count, count};
      };
      const uint64_t count = IsRecorded(x, y) ? recorded.At(x, y, 1).count : 0;
      plate.Add(x, y, plate.defocus_channel(), rays_of(defocus, count));
      plate.Add(x, y, plate.trust_channel(), rays_of(trust, all.At(x, y, 1).count));
      for (int c = 0; c < colours; ++c) {
        if (count > 0) plate.Add(x, y, c, recorded.At(x, y, c % 3));
        plate.Add(x, y, plate.all_rays_channel() + c, all.At(x, y, c % 3));
      }
    }
  return plate;
}

}  // namespace lf::testing
