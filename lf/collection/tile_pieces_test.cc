// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/tile_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

// Returns a segment whose positions, depending on the seed, run straight, bend, change direction,
// hardly move, or leave the plate.
Segment RandomSegment(uint64_t seed) {
  RandomSequence random(seed);
  const double speeds[] = {1e-5, 0.02, 1, 3, 40};
  const double speed = speeds[seed % 5];
  const int begin = static_cast<int>(random.Uniform(0, 200));
  const int end = begin + 1 + static_cast<int>(random.Uniform(0, seed % 3 == 0 ? 5 : 800));
  const double bend = seed % 2 == 0 ? 0 : 2e-3 * speed;
  const Polynomials polynomials = {
      {random.Uniform(-5, 105), random.Uniform(-speed, speed), random.Uniform(-bend, bend), 0},
      {std::floor(random.Uniform(0, 70)), seed % 7 == 0 ? 0 : random.Uniform(-speed, speed), 0, 0}};
  std::vector<Segment> segments;
  AppendSegment(static_cast<int>(seed), begin, end, 0.5 * (begin + end), polynomials, false,
                &segments);
  return segments[0];
}

int ElementAt(const float (&c)[Segment::kTerms], int base, float t, int last) {
  const float position = ((((c[5] * t + c[4]) * t + c[3]) * t + c[2]) * t + c[1]) * t + c[0];
  return static_cast<int>(
      std::clamp(std::floor(double{position}) + base, 0.0, static_cast<double>(last)));
}

TEST(TilePieces, EveryPositionIsInOnePieceOfItsTile) {
  constexpr TileGrid kGrid{100, 70, 33, 16};
  std::vector<Segment> segments;
  for (uint64_t seed = 0; seed < 2000; ++seed) segments.push_back(RandomSegment(seed));
  TilePieces pieces;
  for (const int repeat : {0, 1}) {  // in fresh memory, and in memory that was in use
    pieces.Cut(segments, kGrid);
    std::vector<int> covered(segments.size(), 0);
    size_t piece_count = 0;
    for (size_t tile = 0; tile < kGrid.tile_count(); ++tile) {
      uint32_t last_segment = 0;
      for (const TilePiece* piece = pieces.begin(tile); piece != pieces.end(tile); ++piece) {
        ASSERT_GE(piece->segment, last_segment) << "in the order of the segments";
        last_segment = piece->segment;
        ASSERT_LT(piece->begin, piece->end);
        const Segment& s = segments[piece->segment];
        covered[piece->segment] += piece->end - piece->begin;
        std::vector<int> hits(static_cast<size_t>(kGrid.plate_width) * kGrid.plate_height);
        for (int i = piece->begin; i < piece->end; ++i) {
          const float t = s.t_begin + static_cast<float>(i);
          const int x = ElementAt(s.x_poly, s.base_x, t, kGrid.plate_width - 1);
          const int y = ElementAt(s.y_poly, s.base_y, t, kGrid.plate_height - 1);
          ASSERT_TRUE(kGrid.RectOf(tile).Contains(x, y)) << piece->segment << ": " << i;
          const bool is_clamped =
              x == 0 || y == 0 || x == kGrid.plate_width - 1 || y == kGrid.plate_height - 1;
          const int count = ++hits[static_cast<size_t>(y) * kGrid.plate_width + x];
          ASSERT_TRUE(is_clamped || count <= piece->crowd) << piece->segment;
        }
        ++piece_count;
      }
    }
    for (size_t k = 0; k < segments.size(); ++k) ASSERT_EQ(covered[k], segments[k].count) << k;
    EXPECT_GT(piece_count, 2 * segments.size()) << repeat;
  }
}

}  // namespace
}  // namespace lf
