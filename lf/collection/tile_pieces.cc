#include "lf/collection/tile_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lf {
namespace {

// As kernels evaluate it.
float At(const float (&c)[4], float t) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }

// Single precision keeps the order of positions this far apart.
constexpr float kSureStep = 1e-3F;

int Floor(float f) {
  const int i = static_cast<int>(f);
  return static_cast<float>(i) > f ? i - 1 : i;
}

// A position that is the first on another side of a border between tiles than the one before.
struct Crossing {
  uint16_t index;
  int16_t step;  // to the next column or row of tiles, or back
};

// One coordinate of a segment's positions, counted from its base.
class Axis {
 public:
  // base  of the segment, in elements
  Axis(const float (&cubic)[4], int base, float t_begin, int count, int last_element, int tile_size)
      : cubic_(cubic),
        base_(base),
        t_begin_(t_begin),
        count_(count),
        last_element_(last_element),
        tile_size_(tile_size),
        range_(RangeOf(cubic, t_begin, count)) {}

  // How far positions move, at least, from one to the next; below 0 if they may turn round.
  float least_distance() const { return std::max(range_.least_step, -range_.most_step); }

  // The column or row of tiles of the first position.
  int FirstTile() const { return TileOf(At(cubic_, t_begin_)); }

  // Writes all crossings but at the first position, in order, and one at `count`.
  void Cross(Crossing* crossings) const {
    const int least = TileOf(range_.low), most = TileOf(range_.high);
    if (least != most && count_ > 1) {
      if (range_.least_step > kSureStep)
        for (int tile = least + 1; tile <= most; ++tile) CrossOnce(tile, 1, &crossings);
      else if (range_.most_step < -kSureStep)
        for (int tile = most; tile > least; --tile) CrossOnce(tile, -1, &crossings);
      else
        CrossAtWill(&crossings);
    }
    *crossings = {static_cast<uint16_t>(count_), 0};
  }

 private:
  int TileOf(float position) const {
    return std::clamp(Floor(position) + base_, 0, last_element_) / tile_size_;
  }
  float Position(int i) const { return At(cubic_, t_begin_ + static_cast<float>(i)); }

  // Where the positions, which rise or fall, enter or leave `tile` by its lesser border.
  void CrossOnce(int tile, int step, Crossing** crossings) const {
    const auto border = static_cast<float>(tile * tile_size_ - base_);
    const auto is_behind = [&](int i) { return (Position(i) >= border) == (step > 0); };
    const auto last = static_cast<float>(count_ - 1);
    const float first = Position(0), rise = Position(count_ - 1) - first;
    int index = 1 + static_cast<int>(std::clamp((border - first) * last / rise, 0.0F, last));
    while (index > 0 && is_behind(index - 1)) --index;
    while (index < count_ && !is_behind(index)) ++index;
    if (index > 0 && index < count_)
      *(*crossings)++ = {static_cast<uint16_t>(index), static_cast<int16_t>(step)};
  }

  void CrossAtWill(Crossing** crossings) const {
    int tile = FirstTile();
    for (int i = 1; i < count_; ++i) {
      const int next = TileOf(Position(i));
      if (next == tile) continue;
      *(*crossings)++ = {static_cast<uint16_t>(i), static_cast<int16_t>(next - tile)};
      tile = next;
    }
  }

  const float (&cubic_)[4];
  int base_;
  float t_begin_;
  int count_;
  int last_element_;
  int tile_size_;
  CubicRange range_;
};

struct Cutting {
  TilePiece piece;
  int tile;
};

// The most positions that fall on one element.
uint16_t Crowd(float least_distance, int count) {
  const float crowd = least_distance > 1e-6F ? 2 + 1.01F / least_distance : 1e6F;
  return static_cast<uint16_t>(std::min(static_cast<float>(count), crowd));
}

}  // namespace

void TilePieces::Cut(const std::vector<CubicSegment>& segments, const TileGrid& grid) {
  thread_local std::vector<Cutting> kept;
  std::vector<Cutting> cuttings = std::move(kept);
  cuttings.clear();
  const int columns = grid.columns();
  const int last_x = grid.plate_width - 1, last_y = grid.plate_height - 1;
  tile_begin_.assign(grid.tile_count() + 1, 0);
  for (size_t k = 0; k < segments.size(); ++k) {
    const CubicSegment& s = segments[k];
    const Axis x_axis(s.x_cubic, s.base_x, s.t_begin, s.count, last_x, grid.tile_width);
    const Axis y_axis(s.y_cubic, s.base_y, s.t_begin, s.count, last_y, grid.tile_height);
    Crossing x_crossings[CubicSegment::kMaxCount], y_crossings[CubicSegment::kMaxCount];
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
      // Steps are large where several borders are crossed at once.
      for (; x->index == end && end < s.count; ++x) column += x->step;
      for (; y->index == end && end < s.count; ++y) row += y->step;
      begin = end;
    }
  }
  for (size_t tile = 1; tile < tile_begin_.size(); ++tile)
    tile_begin_[tile] += tile_begin_[tile - 1];
  sorted_.resize(cuttings.size());
  // Each tile's begin moves to its end, which is the begin of the next.
  for (const Cutting& cutting : cuttings)
    sorted_[tile_begin_[static_cast<size_t>(cutting.tile)]++] = cutting.piece;
  std::copy_backward(tile_begin_.begin(), tile_begin_.end() - 1, tile_begin_.end());
  tile_begin_[0] = 0;
  kept = std::move(cuttings);
}

}  // namespace lf
