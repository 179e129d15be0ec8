// SPDX-License-Identifier: Apache-2.0
// Procedural textures: the share of a material's second colour at a point of a surface. Lengths are
// world units on the surface. `width_w` is the width over which the pattern is averaged (the
// footprint of a pixel; 0 for a single point). Patterns are filtered analytically where there is a
// formula, so that a few rays per pixel show no moire.
#pragma once

#include <cstdint>

#include "lf/core/geometry.h"

namespace lf {

// Kinds of patterns. The lengths are multiples of Pattern::scale_w.
enum class PatternKind : uint8_t {
  kPlain,    // the value 0 everywhere
  kChecker,  // squares of side scale_w
  kBars,     // 12 rows of upright bars, scale_w wide in the top row, 4/5 as wide in each row below
  kLetters,  // 12 rows of digits, scale_w high in the top row, 4/5 as high in each row below
  kStar,     // Siemens star of 36 periods around (0, 0), sinusoidal, radius scale_w
  kWood,     // planks along y, scale_w wide, with seams and grain
  kSwirl,    // veins as in glass marbles, about scale_w apart
};

struct Pattern {
  PatternKind kind = PatternKind::kPlain;
  double scale_w = 0.01;
  uint64_t seed = 0;
};

// Returns the pattern's value, in [0, 1], at place_w on the surface, averaged over the width
// width_w. Both are in world units. kLetters is not averaged.
double PatternAt(const Pattern& pattern, const Vec2& place_w, double width_w);

// Returns smooth noise in [0, 1). It has one random value per lattice point, and is interpolated
// between lattice points with cubic weights (smoothstep) along each axis. Its mean is 1/2. Equal
// arguments give equal values on every machine.
double ValueNoise(double x, double y, uint64_t seed);

}  // namespace lf
