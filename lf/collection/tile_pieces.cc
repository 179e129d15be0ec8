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

// One coordinate of a segment's positions, counted from its base.
class Axis {
 public:
  Axis(const float (&cubic)[4], float t_begin, int count)
      : cubic_(cubic), t_begin_(t_begin), count_(count) {
    const CubicRange range = RangeOf(cubic, t_begin, count);
    low_ = range.low;
    high_ = range.high;
    is_rising_ = range.least_step > kSureStep;
    is_falling_ = range.most_step < -kSureStep;
    least_distance_ = std::max(range.least_step, -range.most_step);
  }

  // How far positions move, at least, from one to the next; below 0 if they may turn round.
  float least_distance() const { return least_distance_; }

  // Appends the indices, within (0, count), that are the first on another side of a border between
  // tiles than those before. `base` is that of the segment in elements, `size` that of tiles.
  uint16_t* AppendCuts(int base, int last_element, int size, uint16_t* cuts) const {
    const int first_tile = std::clamp(Floor(low_) + base, 0, last_element) / size;
    const int last_tile = std::clamp(Floor(high_) + base, 0, last_element) / size;
    if (first_tile == last_tile || count_ == 1) return cuts;
    for (int tile = first_tile + 1; tile <= last_tile; ++tile)
      cuts = AppendCut(static_cast<float>(tile * size - base), cuts);
    return cuts;
  }

 private:
  bool IsBeyond(int i, float border) const {
    return At(cubic_, t_begin_ + static_cast<float>(i)) >= border;
  }

  uint16_t* AppendCut(float border, uint16_t* cuts) const {
    if (!is_rising_ && !is_falling_) {
      for (int i = 1; i < count_; ++i)
        if (IsBeyond(i, border) != IsBeyond(i - 1, border)) *cuts++ = static_cast<uint16_t>(i);
      return cuts;
    }
    const auto last = static_cast<float>(count_ - 1);
    const float first = At(cubic_, t_begin_), rise = At(cubic_, t_begin_ + last) - first;
    int cut = static_cast<int>(std::clamp((border - first) * last / rise, 0.0F, last));
    while (cut > 0 && IsBeyond(cut - 1, border) == is_rising_) --cut;
    while (cut < count_ && IsBeyond(cut, border) != is_rising_) ++cut;
    if (cut > 0 && cut < count_) *cuts++ = static_cast<uint16_t>(cut);
    return cuts;
  }

  const float (&cubic_)[4];
  float t_begin_;
  int count_;
  float low_, high_, least_distance_;
  bool is_rising_, is_falling_;
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
    const Axis x_axis(s.x_cubic, s.t_begin, s.count), y_axis(s.y_cubic, s.t_begin, s.count);
    uint16_t cuts[2 * CubicSegment::kMaxCount + 1];
    uint16_t* const x_cuts = x_axis.AppendCuts(s.base_x, last_x, grid.tile_width, cuts);
    uint16_t* cuts_end = y_axis.AppendCuts(s.base_y, last_y, grid.tile_height, x_cuts);
    if (cuts_end > cuts + 1) std::sort(cuts, cuts_end);
    *cuts_end++ = static_cast<uint16_t>(s.count);
    const uint16_t crowd =
        Crowd(std::max(x_axis.least_distance(), y_axis.least_distance()), s.count);
    uint16_t begin = 0;
    for (const uint16_t* cut = cuts; cut != cuts_end; ++cut) {
      if (begin == *cut) continue;  // cut by both axes
      const float t = s.t_begin + static_cast<float>(begin);
      const int x = std::clamp(Floor(At(s.x_cubic, t)) + s.base_x, 0, last_x);
      const int y = std::clamp(Floor(At(s.y_cubic, t)) + s.base_y, 0, last_y);
      const int tile = y / grid.tile_height * columns + x / grid.tile_width;
      cuttings.push_back({{static_cast<uint32_t>(k), begin, *cut, crowd}, tile});
      ++tile_begin_[static_cast<size_t>(tile) + 1];
      begin = *cut;
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
