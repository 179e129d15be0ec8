// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/tile_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lf {
namespace {

// Positions that are at least this far apart, in elements, keep their order in single precision.
constexpr float kSureStep = 1e-3F;

int Floor(float f) {
  const int i = static_cast<int>(f);
  return static_cast<float>(i) > f ? i - 1 : i;
}

// A crossing of a border between tiles. `index` is the first position beyond the border.
struct Crossing {
  uint16_t index;
  int16_t step;  // change of the column or row of tiles
};

// One coordinate of a segment's positions, counted from the base of the segment.
class Axis {
 public:
  //   base  base_x or base_y of the segment, in elements
  Axis(const float (&polynomial)[Segment::kTerms], int base, float t_begin, int count,
       int last_element, int tile_size)
      : polynomial_(polynomial),
        base_(base),
        t_begin_(t_begin),
        count_(count),
        last_element_(last_element),
        tile_size_(tile_size),
        range_(RangeOf(polynomial, t_begin, count)) {}

  // Smallest distance from one position to the next; at most 0 if positions may change direction.
  float least_distance() const { return std::max(range_.least_step, -range_.most_step); }

  // Returns the column or row of tiles that contains the first position.
  int FirstTile() const { return TileOf(range_.first); }

  // Writes all crossings in order, and then a terminator with the index `count`.
  void Cross(Crossing* crossings) const {
    CrossWithin(0, count_ - 1, range_, &crossings);
    *crossings = {static_cast<uint16_t>(count_), 0};
  }

 private:
  int TileOf(float position) const {
    return std::clamp(Floor(position) + base_, 0, last_element_) / tile_size_;
  }
  float At(float i) const { return PositionAt(polynomial_, t_begin_ + i); }
  float Position(int i) const { return At(static_cast<float>(i)); }

  // Writes the crossings at positions (first, last]. Halves this range if positions may change
  // direction in it.
  void CrossWithin(int first, int last, const PositionRange& range, Crossing** crossings) const {
    const int least = TileOf(range.low), most = TileOf(range.high);
    if (least == most || first == last) return;
    if (range.least_step > kSureStep) {
      for (int tile = least + 1; tile <= most; ++tile)
        CrossOnce(first, last, range, tile, 1, crossings);
    } else if (range.most_step < -kSureStep) {
      for (int tile = most; tile > least; --tile)
        CrossOnce(first, last, range, tile, -1, crossings);
    } else if (constexpr int kFew = 8; last - first <= kFew) {
      CrossAtWill(first, last, crossings);
    } else {
      const int middle = first + (last - first) / 2;
      CrossWithin(first, middle, Range(first, middle), crossings);
      CrossWithin(middle, last, Range(middle, last), crossings);
    }
  }
  PositionRange Range(int first, int last) const {
    return RangeOf(polynomial_, t_begin_ + static_cast<float>(first), last - first + 1);
  }

  // Writes the crossing of the left (or upper) border of the column (or row) `tile` of tiles, if
  // there is one. From first to last, positions must only rise (step 1) or only fall (step -1).
  void CrossOnce(int first, int last, const PositionRange& range, int tile, int step,
                 Crossing** crossings) const {
    const auto border = static_cast<float>(tile * tile_size_ - base_);
    const auto is_behind = [&](int i) { return (Position(i) >= border) == (step > 0); };
    const auto steps = static_cast<float>(last - first);
    const float inverse = steps / (range.last - range.first);
    // The chord yields a first estimate, which is corrected by the error of the position there. The
    // result is usually wrong by at most one position.
    float place = std::clamp((border - range.first) * inverse, 0.0F, steps);
    const float found = At(static_cast<float>(first) + place);
    place = std::clamp(place + (border - found) * inverse, 0.0F, steps);
    int index = first + 1 + static_cast<int>(place);
    while (index > first && is_behind(index - 1)) --index;
    while (index <= last && !is_behind(index)) ++index;
    if (index > first && index <= last)
      *(*crossings)++ = {static_cast<uint16_t>(index), static_cast<int16_t>(step)};
  }

  void CrossAtWill(int first, int last, Crossing** crossings) const {
    int tile = TileOf(Position(first));
    for (int i = first + 1; i <= last; ++i) {
      const int next = TileOf(Position(i));
      if (next == tile) continue;
      *(*crossings)++ = {static_cast<uint16_t>(i), static_cast<int16_t>(next - tile)};
      tile = next;
    }
  }

  const float (&polynomial_)[Segment::kTerms];
  int base_;
  float t_begin_;
  int count_;
  int last_element_;
  int tile_size_;
  PositionRange range_;
};

struct Cutting {
  TilePiece piece;
  int tile;
};

// Returns a bound of the number of positions that fall on one element, if neighbouring positions
// are at least `least_distance` apart.
uint16_t Crowd(float least_distance, int count) {
  const float crowd = least_distance > 1e-6F ? 2 + 1.01F / least_distance : 1e6F;
  return static_cast<uint16_t>(std::min(static_cast<float>(count), crowd));
}

}  // namespace

void TilePieces::Cut(const std::vector<Segment>& segments, const TileGrid& grid) {
  thread_local std::vector<Cutting> kept;
  std::vector<Cutting> cuttings = std::move(kept);
  cuttings.clear();
  const int columns = grid.columns();
  const int last_x = grid.plate_width - 1, last_y = grid.plate_height - 1;
  tile_begin_.assign(grid.tile_count() + 1, 0);
  for (size_t k = 0; k < segments.size(); ++k) {
    const Segment& s = segments[k];
    const Axis x_axis(s.x_poly, s.base_x, s.t_begin, s.count, last_x, grid.tile_width);
    const Axis y_axis(s.y_poly, s.base_y, s.t_begin, s.count, last_y, grid.tile_height);
    Crossing x_crossings[Segment::kMaxCount], y_crossings[Segment::kMaxCount];
    x_axis.Cross(x_crossings);
    y_axis.Cross(y_crossings);
    const Crossing *x = x_crossings, *y = y_crossings;
    int column = x_axis.FirstTile(), row = y_axis.FirstTile();
    const uint16_t crowd =
        Crowd(std::max(x_axis.least_distance(), y_axis.least_distance()), s.count);
    for (int begin = 0; begin < s.count;) {
      const uint16_t end = std::min(x->index, y->index);
      const int tile = row * columns + column;
      cuttings.push_back(
          {{static_cast<uint32_t>(k), static_cast<uint16_t>(begin), end, crowd}, tile});
      ++tile_begin_[static_cast<size_t>(tile) + 1];
      // Several borders may be crossed at once.
      for (; x->index == end && end < s.count; ++x) column += x->step;
      for (; y->index == end && end < s.count; ++y) row += y->step;
      begin = end;
    }
  }
  for (size_t tile = 1; tile < tile_begin_.size(); ++tile)
    tile_begin_[tile] += tile_begin_[tile - 1];
  sorted_.resize(cuttings.size());
  // Sorts the pieces by tile. Each entry of tile_begin_ advances from the first piece of its tile
  // to the first piece of the next tile.
  for (const Cutting& cutting : cuttings)
    sorted_[tile_begin_[static_cast<size_t>(cutting.tile)]++] = cutting.piece;
  std::copy_backward(tile_begin_.begin(), tile_begin_.end() - 1, tile_begin_.end());
  tile_begin_[0] = 0;
  kept = std::move(cuttings);
}

}  // namespace lf
