// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/plane_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lf {
namespace {

constexpr int kQuarters = 4;
constexpr int kSets = 5;
// The quarters (LensView::Quarter()) of each set, as bits: the whole lens, left, right, lower and
// upper half.
constexpr std::array<unsigned, kSets> kQuartersOf = {0b1111, 0b0101, 0b1010, 0b0011, 0b1100};
constexpr float kNoCost = std::numeric_limits<float>::infinity();
// Variance of the roots that 8 bits of a stored value leave, about 65535 / 255 / sqrt(12) in each
// of three colours. Smaller differences between costs mean nothing.
constexpr float kFloor = 3 * 74.0f * 74.0f;
// A half of the lens is believed instead of the whole one if its least cost is at most this share
// of the other's, because costs of halves are smaller everywhere.
constexpr float kHalfBelow = 0.4f;
// An element's own cost should be this much higher one element away from its least cost.
constexpr float kOwnRise = 1.5f;
constexpr float kOwnFloor = kFloor / 4;
// Minima within this number of distances from the best one belong to it.
constexpr int kSameMinimum = 2;

// The sums of the views of a quarter of the lens at one element.
struct QuarterSums {
  uint32_t count = 0;
  std::array<uint32_t, 3> roots = {};
  uint64_t squares = 0;
};
using CellSums = std::array<QuarterSums, kQuarters>;

// Adds a view's light at the elements of `area` to their sums.
void AddView(const LensView& view, const RenderCamera& frame, double distance_w,
             const PixelRect& area, std::vector<CellSums>* cells) {
  const PlanePositions positions(view, frame, distance_w);
  // From the centre of the first loaded pixel.
  const double first_x = view.rect.x_begin + 0.5, first_y = view.rect.y_begin + 0.5;
  const double most_x = view.light.width() - 1, most_y = view.light.height() - 1;
  const auto quarter = static_cast<size_t>(view.Quarter());
  CellSums* cell = cells->data();
  for (int y = area.y_begin; y < area.y_end; ++y) {
    for (int x = area.x_begin; x < area.x_end; ++x, ++cell) {
      const Vec3 at = positions.At(x + 0.5, y + 0.5);
      const double inverse = 1 / at.z();
      const double across = at.x() * inverse - first_x, down = at.y() * inverse - first_y;
      if (!(across >= 0 && across < most_x && down >= 0 && down < most_y)) continue;
      const int column = static_cast<int>(across), row = static_cast<int>(down);
      const auto right = static_cast<uint32_t>((across - column) * 256);
      const auto below = static_cast<uint32_t>((down - row) * 256);
      const uint16_t* const p = &view.light.at(column, row);
      const uint16_t* const q = &view.light.at(column, row + 1);
      if (view.any_masked && (p[3] & p[7] & q[3] & q[7]) == 0) continue;
      const uint32_t weights[4] = {(256 - right) * (256 - below), right * (256 - below),
                                   (256 - right) * below, right * below};
      QuarterSums& sums = (*cell)[quarter];
      ++sums.count;
      for (size_t c = 0; c < 3; ++c) {
        const uint64_t root =
            (uint64_t{p[c]} * weights[0] + uint64_t{p[4 + c]} * weights[1] +
             uint64_t{q[c]} * weights[2] + uint64_t{q[4 + c]} * weights[3] + 32768) >>
            16;
        sums.roots[c] += static_cast<uint32_t>(root);
        sums.squares += root * root;
      }
    }
  }
}

float CostOf(const CellSums& cell, unsigned quarters) {
  uint64_t count = 0, squares = 0;
  std::array<uint64_t, 3> roots = {};
  for (size_t q = 0; q < kQuarters; ++q) {
    if ((quarters >> q & 1) == 0) continue;
    count += cell[q].count;
    squares += cell[q].squares;
    for (size_t c = 0; c < 3; ++c) roots[c] += cell[q].roots[c];
  }
  if (count < kLeastViews) return kNoCost;
  uint64_t spread = count * squares;
  for (const uint64_t root : roots) spread -= root * root;
  return static_cast<float>(static_cast<double>(spread) /
                            (static_cast<double>(count) * static_cast<double>(count - 1)));
}

// The mean roots of each set of views at its least cost so far.
class LeastColours {
 public:
  explicit LeastColours(const PixelRect& tile)
      : area_(static_cast<size_t>(tile.pixel_count())),
        least_(kSets * area_, kNoCost),
        roots_(kSets * area_) {}

  // Adds the sums of a distance.
  //   costs  means over windows of the set, of each element of the tile
  //   cells  of the tile and `radius` elements around it
  void Add(size_t set, const float* costs, const std::vector<CellSums>& cells,
           const PixelRect& tile, int radius) {
    const int stride = tile.width() + 2 * radius;
    for (size_t i = 0; i < area_; ++i) {
      if (!(costs[i] < least_[set * area_ + i])) continue;
      least_[set * area_ + i] = costs[i];
      const int x = static_cast<int>(i) % tile.width(), y = static_cast<int>(i) / tile.width();
      roots_[set * area_ + i] =
          MeanOf(cells[static_cast<size_t>((y + radius) * stride + x + radius)], kQuartersOf[set]);
    }
  }
  const std::array<uint16_t, 3>& At(size_t set, size_t element) const {
    return roots_[set * area_ + element];
  }

 private:
  static std::array<uint16_t, 3> MeanOf(const CellSums& cell, unsigned quarters) {
    uint32_t count = 0;
    std::array<uint64_t, 3> sums = {};
    for (size_t q = 0; q < kQuarters; ++q) {
      if ((quarters >> q & 1) == 0) continue;
      count += cell[q].count;
      for (size_t c = 0; c < 3; ++c) sums[c] += cell[q].roots[c];
    }
    std::array<uint16_t, 3> mean = {};
    for (size_t c = 0; c < 3; ++c) mean[c] = static_cast<uint16_t>(sums[c] / count);
    return mean;
  }

  size_t area_;
  std::vector<float> least_;                    // [set][element]
  std::vector<std::array<uint16_t, 3>> roots_;  // [set][element]
};

// The costs of a tile: [set][distance][element].
class CostVolume {
 public:
  CostVolume(size_t distance_count, const PixelRect& tile)
      : distance_count_(distance_count),
        area_(static_cast<size_t>(tile.pixel_count())),
        costs_(kSets * distance_count * area_) {}

  float* Layer(size_t set, size_t distance) {
    return &costs_[(set * distance_count_ + distance) * area_];
  }
  float At(size_t set, size_t distance, size_t element) const {
    return costs_[(set * distance_count_ + distance) * area_ + element];
  }
  size_t distance_count() const { return distance_count_; }

 private:
  size_t distance_count_;
  size_t area_;
  std::vector<float> costs_;
};

// Writes the means of costs over windows. Elements without a cost are left out of the means. Sums
// are always added in the same order, first along rows, so that tiles do not change them.
//   costs  of the tile and `radius` elements around it
void MeanOverWindows(const std::vector<float>& costs, const PixelRect& tile, int radius,
                     float* means) {
  const int stride = tile.width() + 2 * radius, rows = tile.height() + 2 * radius;
  const int side = 2 * radius + 1;
  thread_local std::vector<float> sums;  // over `side` elements of a row, [rows][tile.width()]
  thread_local std::vector<int> counts;
  sums.clear();
  counts.clear();
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < tile.width(); ++x) {
      const float* const row = &costs[static_cast<size_t>(y * stride + x)];
      float sum = 0;
      int count = 0;
      for (int i = 0; i < side; ++i) {
        const bool has_cost = row[i] != kNoCost;
        sum += has_cost ? row[i] : 0;
        count += has_cost ? 1 : 0;
      }
      sums.push_back(sum);
      counts.push_back(count);
    }
  for (int y = 0; y < tile.height(); ++y)
    for (int x = 0; x < tile.width(); ++x) {
      float sum = 0;
      int count = 0;
      for (int j = 0; j < side; ++j) {
        const auto at = static_cast<size_t>((y + j) * tile.width() + x);
        sum += sums[at];
        count += counts[at];
      }
      const bool has_cost =
          costs[static_cast<size_t>((y + radius) * stride + x + radius)] != kNoCost;
      *means++ = has_cost ? sum / static_cast<float>(count) : kNoCost;
    }
}

// Writes the costs of the tile's elements alone.
void CopyInner(const std::vector<float>& costs, const PixelRect& tile, int radius, float* inner) {
  const int stride = tile.width() + 2 * radius;
  for (int y = 0; y < tile.height(); ++y)
    inner = std::copy_n(costs.begin() + (y + radius) * stride + radius, tile.width(), inner);
}

// The least cost of one set at one element, and how it stands out.
struct Minimum {
  size_t index = 0;
  float least = kNoCost;
  float rival = kNoCost;  // least cost of a local minimum elsewhere
  float mean = 0;         // over all distances with a cost
};

Minimum MinimumOf(const CostVolume& costs, size_t set, size_t element) {
  Minimum minimum;
  const size_t count = costs.distance_count();
  double sum = 0;
  size_t valid = 0;
  for (size_t d = 0; d < count; ++d) {
    const float cost = costs.At(set, d, element);
    if (cost == kNoCost) continue;
    sum += cost;
    ++valid;
    if (cost < minimum.least) {
      minimum.least = cost;
      minimum.index = d;
    }
  }
  if (valid == 0) return minimum;
  minimum.mean = static_cast<float>(sum / static_cast<double>(valid));
  for (size_t d = 0; d < count; ++d) {
    if (d + kSameMinimum >= minimum.index && d <= minimum.index + kSameMinimum) continue;
    const float cost = costs.At(set, d, element);
    const float before = d > 0 ? costs.At(set, d - 1, element) : kNoCost;
    const float after = d + 1 < count ? costs.At(set, d + 1, element) : kNoCost;
    if (cost <= before && cost <= after) minimum.rival = std::min(minimum.rival, cost);
  }
  return minimum;
}

// Returns the index, with a fraction, of the lowest point of the parabola through the least cost
// and the costs beside it.
float Vertex(const CostVolume& costs, size_t set, size_t element, size_t index) {
  const float before = costs.At(set, index - 1, element);
  const float least = costs.At(set, index, element);
  const float after = costs.At(set, index + 1, element);
  const float bend = before - 2 * least + after;
  const auto whole = static_cast<float>(index);
  if (!(bend > 0) || before == kNoCost || after == kNoCost) return whole;
  return whole + std::clamp(0.5f * (before - after) / bend, -0.5f, 0.5f);
}

// Returns true if an element's own cost rises on both sides of a distance.
bool Rises(const CostVolume& own, size_t set, size_t element, size_t index, size_t step) {
  const float limit = kOwnRise * own.At(set, index, element) + kOwnFloor;
  const size_t before = index - std::min(index, step);
  const size_t after = std::min(index + step, own.distance_count() - 1);
  return own.At(set, before, element) > limit && own.At(set, after, element) > limit;
}

SweptDepth DepthOf(const CostVolume& costs, const CostVolume& own, const LeastColours& colours,
                   size_t element_step, size_t element) {
  size_t set = 0;
  Minimum best = MinimumOf(costs, 0, element);
  // Only relative to the cost of the whole lens is a half better.
  float limit = kHalfBelow * (best.least + kFloor);
  for (size_t half = 1; half < kSets; ++half) {
    const Minimum minimum = MinimumOf(costs, half, element);
    if (!(minimum.least + kFloor < limit)) continue;
    limit = minimum.least + kFloor;
    best = minimum;
    set = half;
  }
  if (best.least == kNoCost) return {};
  SweptDepth depth;
  depth.index = static_cast<float>(best.index);
  depth.roots = colours.At(set, element);
  if (best.index == 0 || best.index + 1 == costs.distance_count()) return depth;
  depth.index = Vertex(costs, set, element, best.index);
  const float least = best.least + kFloor;
  // A local minimum elsewhere that is nearly as low may be the right one.
  const float rival = best.rival == kNoCost ? best.mean + kFloor : best.rival + kFloor;
  depth.confidence = std::clamp(1 - least / std::min(best.mean + kFloor, rival), 0.0f, 1.0f);
  if (!Rises(own, set, element, best.index, element_step)) depth.confidence *= kDoubtful;
  return depth;
}

}  // namespace

void SweepTile(std::span<const LensView> views, const RenderCamera& frame,
               const SweepOptions& options, const PixelRect& tile,
               std::vector<SweptDepth>* depths) {
  const int radius = options.window_radius;
  const PixelRect area = {tile.x_begin - radius, tile.y_begin - radius, tile.x_end + radius,
                          tile.y_end + radius};
  CostVolume costs(options.distances_w.size(), tile);  // means over windows
  CostVolume own(options.distances_w.size(), tile);    // of single elements
  LeastColours colours(tile);
  std::vector<CellSums> cells(static_cast<size_t>(area.pixel_count()));
  std::vector<float> of_distance(cells.size());
  for (size_t d = 0; d < options.distances_w.size(); ++d) {
    std::fill(cells.begin(), cells.end(), CellSums());
    for (const LensView& view : views)
      if (view.of.is_swept) AddView(view, frame, options.distances_w[d], area, &cells);
    for (size_t set = 0; set < kSets; ++set) {
      for (size_t i = 0; i < cells.size(); ++i) of_distance[i] = CostOf(cells[i], kQuartersOf[set]);
      MeanOverWindows(of_distance, tile, radius, costs.Layer(set, d));
      colours.Add(set, costs.Layer(set, d), cells, tile, radius);
      CopyInner(of_distance, tile, radius, own.Layer(set, d));
    }
  }
  depths->clear();
  for (size_t i = 0; i < static_cast<size_t>(tile.pixel_count()); ++i)
    depths->push_back(DepthOf(costs, own, colours, options.element_step, i));
}

}  // namespace lf
