// SPDX-License-Identifier: Apache-2.0
// A sequence of points of the unit square, every beginning of which is spread evenly: a
// (0,2)-sequence in base 2 (Niederreiter, "Random Number Generation and Quasi-Monte Carlo Methods",
// 1992), scrambled by a seed (Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995).
//
// Divide the unit square into 2^m equal rectangles by halving its sides: 2^a columns and 2^(m-a)
// rows, for any a. Each rectangle then holds exactly one of the points i 2^m to (i+1) 2^m - 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lf {

// Coordinates from 0 to 1, exclusive, in units of 2^-32.
struct SpreadPoint {
  uint32_t x = 0;
  uint32_t y = 0;
};

// Returns the first `count` points, at most 2^32. The first points of a longer sequence are those
// of a shorter one. Integer arithmetic alone makes them, so that they are the same on all machines.
//
// Also every second, fourth, eighth and sixteenth point from any point on are spread, so that the
// parts into which a render may be divided (Shard) are: their t-value is at most 2 for up to 64
// points. A Sobol' sequence in its usual order lacks this: every second of its points is in one
// half of the square.
//   stream  sequences of different streams are independent of each other
std::vector<SpreadPoint> SpreadSequence(size_t count, uint64_t seed, uint64_t stream = 0);

}  // namespace lf
